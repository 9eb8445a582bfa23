#pragma once

#include <filesystem>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

namespace trackbed {

/// Reads the log of a real vehicle.
///
/// ImportLog first drops rows of the log that are invalid according to the log map, and rows
/// without a number in a pose column (empty or "nan"). ImportLog also drops rows with the same time
/// as the previous row. The remaining rows form stretches; a time of more than `gap` between two
/// rows ends a stretch. The measured pose X_WS of the sensor is converted to the pose of the rear
/// axle, X_WV = X_WS X_VS^-1, with the sensor's pose X_VS in the vehicle frame. At each point of
/// the time grid, weighted least squares (Eigen) fit a polynomial of the degree `degree`. The fit
/// at a point of the time grid uses the rows of the same stretch from `half_width` before the point
/// to `half_width` after the point. In the fit, the weight of a row is (1 - u^3)^3, where u is the
/// time between row and point, divided by `half_width` (Cleveland 1979). Pose, velocity and
/// acceleration are the value and the first and second derivative of the fitted polynomial. If
/// fewer than `degree` + 1 rows are within the time `half_width` of a point, the fit also uses the
/// nearest other rows. Columns for speed or yaw rate, if the log has any, are fitted in the same
/// way and replace the values computed from the pose. Commands and steering angles are interpolated
/// linearly between rows, or between the updates of a slower control loop.
///
/// Guarantees: the fit adds no phase shift, because the rows on both sides of a point are used
/// symmetrically (except at the ends of a stretch). If the recorded motion is a polynomial of the
/// degree `degree` in time, the pose, velocity and acceleration are exact to rounding. Samples in
/// gaps are marked invalid; the values of these samples are interpolated linearly between the ends
/// of the gap. RecordedDrive::notes lists the processing steps.
///
/// Throws InputError, with file and line, if a column is missing (the message suggests the most
/// similar name), if a cell is not a number, or if times decrease. ImportLog also throws InputError
/// if the position never changes, or if the log yields less than 1 s of data or more than 1e6
/// samples. Throws InputError if the columns that the log map names have more than 5e7 numbers
/// between `from` and `to`. Throws InputError, with the key of the log map, if columns contradict
/// each other. Examples of contradicting columns: the yaw or yaw rate has the wrong unit (degrees
/// or radians), or its sign is opposite to the turns of the path. Another example is a measured
/// speed with the wrong unit (km/h or m/s), which differs from the speed of the position by a
/// factor of 3.6. If `map.check` is false, contradictions between columns are only listed in the
/// notes. Throws RunError in the same cases as ReadFile.
///
/// Delays of at most 1 s between the pose and the measured speed, yaw rate and accelerations are
/// estimated with their standard errors. A delay is noted if it exceeds both three standard errors
/// and the mean time between two rows. If `map.align` is true, the signals with noted delays are
/// shifted onto the clock of the pose. A delay of the yaw rate behind the steering is noted but not
/// removed, because the response of the car contributes to this delay. A steering signal that lags
/// the yaw rate is shifted if `map.align` is true. Drift of the measured signals is not removed.
/// The import takes 1 us per row and 10 us per sample. The file is read once as a stream, and each
/// number that is kept needs 16 bytes of memory.
RecordedDrive ImportLog(const std::filesystem::path& log, const LogMap& map);

}  // namespace trackbed
