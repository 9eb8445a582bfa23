#pragma once

#include <filesystem>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Reads the log of a real vehicle.
///
/// Steps: drops rows that are invalid by the map, rows without a number in a pose column (empty or
/// "nan"), and rows with the same time as the previous row. Rows further apart than `gap` end a
/// stretch. The measured pose is converted to that of the rear axle, X_WV = X_WS X_VS^-1. On the
/// grid, weighted least squares (Eigen) fit a polynomial of `degree` to the rows of the same
/// stretch within `half_width` on either side, with weights (1 - u^3)^3 (Cleveland 1979). The
/// value, slope and curvature of the polynomial give pose, velocity and acceleration. If the window
/// has fewer than `degree` + 1 rows, the nearest ones are added. If speed or yaw rate have columns,
/// they are fitted in the same way and replace the values from the pose. Commands and steering are
/// interpolated linearly between rows, or between the updates of a slower loop.
///
/// Guarantees: the fit adds no phase, because windows are symmetric (except at the ends of a
/// stretch). Pose, velocity and acceleration are exact, to rounding, for motions that are
/// polynomials of `degree` in time. Samples in gaps are marked invalid; their values are
/// interpolated linearly between the gap's ends. The processing steps are listed in
/// RecordedDrive::notes.
///
/// Errors: InputError with file and line for missing columns (with the nearest spelling), cells
/// that are not numbers, times that decrease, a position that never changes, less than 1 s of data,
/// and more than 1e6 samples. InputError for more than 5e7 numbers in the columns of the map
/// between `from` and `to`. InputError with the key of the map for columns that contradict each
/// other. Examples are yaw or yaw rate in degrees read as radians or vice versa, or with the
/// opposite sign to the path's turns, and a speed 3.6 times as large or small as that of the
/// position. If `map.check` is false, contradictions only become notes. Throws the RunErrors of
/// ReadFile.
///
/// Time shifts between sensors are not detected, and drift is not removed. Cost: 1 us per row and 5
/// us per sample. The file is read once as a stream; each kept number needs 16 bytes.
RecordedDrive ImportLog(const std::filesystem::path& log, const LogMap& map);

}  // namespace trackbed
