#pragma once

#include <filesystem>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Reads the log of a real vehicle.
///
/// Steps: drops rows that the map calls invalid, rows without a number in a pose column (empty or
/// "nan"), and rows with the time of the previous one; rows further apart than `gap` end a stretch.
/// The measured pose is converted to that of the rear axle, X_WV = X_WS X_VS^-1. On the grid,
/// weighted least squares (Eigen) fit a polynomial of `degree` to the rows of the same stretch
/// within `half_width` on either side, with weights (1 - u^3)^3 (Cleveland 1979): its value, slope
/// and curvature give pose, velocity and acceleration. If the window has fewer than `degree` + 1
/// rows, the nearest ones are added. Speed and yaw rate, if they have columns, are fitted in the
/// same way and replace those of the pose. Commands and steering are linear between rows, or
/// between the updates of a slower loop.
///
/// Guarantees: adds no phase (windows are symmetric, except at the ends of a stretch); pose,
/// velocity and acceleration are exact, to rounding, for motions that are polynomials of `degree`
/// in time. Samples in gaps are marked invalid; their values are interpolated linearly between the
/// gap's ends.
/// RecordedDrive::notes lists the processing.
///
/// Errors: InputError with file and line for missing columns (with the nearest spelling), cells
/// that are not numbers, times that go back, a position that never changes, less than 1 s of data,
/// more than 5e7 numbers in the columns of the map between `from` and `to`, or more than 1e6
/// samples. InputError with the key of the map for columns that contradict each other: yaw or yaw
/// rate in degrees read as radians or vice versa, or with the opposite sign to the path's turns,
/// and a speed 3.6 times as large or small as that of the position; if `map.check` is false, these
/// become notes. RunError as ReadFile.
///
/// Does not detect time shifts between sensors, nor remove drift. Cost: the file is read once as a
/// stream; 16 bytes for each number that is kept; 1 us per row and 5 us per sample.
RecordedDrive ImportLog(const std::filesystem::path& log, const LogMap& map);

}  // namespace trackbed
