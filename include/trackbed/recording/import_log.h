#pragma once

#include <filesystem>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Reads the log of a real vehicle.
///
/// Steps: drops rows that are invalid according to the map, rows without a number in a pose column
/// (empty or "nan"), and rows with the same time as the previous row. A time of more than `gap`
/// between two rows ends a stretch. The measured pose is converted to that of the rear axle, X_WV =
/// X_WS X_VS^-1. At each point of the time grid, weighted least squares (Eigen) fit a polynomial of
/// `degree` to the rows of the same stretch within `half_width` on either side, with weights (1 -
/// u^3)^3 (Cleveland 1979). The value, slope and curvature of the polynomial give pose, velocity
/// and acceleration. If the window has fewer than `degree` + 1 rows, the nearest rows are added. If
/// the log has columns for speed or yaw rate, they are fitted in the same way and replace the
/// values computed from the pose. Commands and steering are interpolated linearly between rows, or
/// between the updates of a slower loop.
///
/// Guarantees: the fit adds no phase shift, because windows are symmetric (except at the ends of a
/// stretch). Pose, velocity and acceleration are exact, to rounding, for motions that are
/// polynomials of `degree` in time. Samples in gaps are marked invalid; their values are
/// interpolated linearly between the gap's ends. The processing steps are listed in
/// RecordedDrive::notes.
///
/// Errors: InputError with file and line for missing columns (with the nearest spelling), cells
/// that are not numbers, times that decrease, a position that never changes, less than 1 s of data,
/// and more than 1e6 samples. InputError for more than 5e7 numbers in the columns of the map
/// between `from` and `to`. InputError with the key of the log map for columns that contradict each
/// other. Examples are a yaw or yaw rate with the wrong unit (degrees or radians) or with the
/// opposite sign to the path's turns, and a speed that differs from the speed of the position by a
/// factor of 3.6. If `map.check` is false, contradictions only become notes. Throws the RunErrors
/// of ReadFile.
///
/// Time shifts between sensors are not detected, and drift is not removed. Cost: 1 us per row and 5
/// us per sample. The file is read once as a stream; each kept number needs 16 bytes.
RecordedDrive ImportLog(const std::filesystem::path& log, const LogMap& map);

}  // namespace trackbed
