#pragma once

#include <filesystem>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Reads the log of a real vehicle.
///
/// Steps: rows that the map calls invalid or that have no number in a pose column (empty or "nan")
/// are dropped; a row of the time of the one before is dropped; rows further apart than `gap` end
/// a stretch. The measured pose becomes that of the rear axle, X_WV = X_WS X_VS^-1. On the grid,
/// weighted least squares (Eigen) fit a polynomial of `degree` to the rows of the same stretch
/// within `half_width` on either side, weights (1 - u^3)^3 (Cleveland 1979): its value, slope and
/// curvature are pose, velocity and acceleration. Less than `degree` + 1 rows within are made up
/// for by the nearest ones. Speed and yaw rate of columns of their own are fitted likewise and
/// replace those of the pose. Commands and steering are linear between rows, or between the updates
/// of a slower loop.
///
/// Guarantees: no phase is added (windows are symmetric, but at the ends of a stretch); pose,
/// velocity and acceleration are exact for motions that are polynomials of `degree` in time, to
/// rounding. Samples in gaps are not valid, and linear between the gap's ends. What was done is in
/// RecordedDrive::notes.
///
/// Errors: InputError with file and line for missing columns (with the nearest spelling), cells
/// that are no numbers, times that go back, a position that never changes, less than 1 s of data,
/// more than 5e7 numbers in the columns of the map between `from` and `to`, or more than 1e6
/// samples; with the key of the map for columns that contradict each other, unless `map.check` is
/// false, which makes notes of them: yaw or yaw rate in degrees read as radians or the other way
/// round, turning the other way than the path does, and a speed 3.6 times as large or small as that
/// of the position. RunError as ReadFile.
///
/// Does not: find out time shifts between sensors, or remove drift.
/// Cost: the file is read once as a stream; 16 bytes for each number that is kept; 1 us per row and
/// 5 us per sample.
RecordedDrive ImportLog(const std::filesystem::path& log, const LogMap& map);

}  // namespace trackbed
