#pragma once

#include <variant>
#include <vector>

/// The standard maneuvers of vehicle dynamics: how a run is evaluated. The controller steers and
/// brakes; a maneuver defines what is measured.
namespace trackbed {

/// ISO 4138: steady-state circular driving test. Samples count after `settle`, where the yaw rate
/// changes slowly; gradients are least squares over those with fit_from <= |a_y| <= fit_to.
struct SteadyStateCircleOptions {
  double settle = 2.0;    ///< [s]
  double fit_from = 0.5;  ///< [m/s^2]
  double fit_to = 4.0;    ///< [m/s^2]
};

/// SAE J266, method 2: slowly increasing steer at constant speed; the metrics of
/// SteadyStateCircleOptions, and the steering angle at 0.3 g.
struct SlowlyIncreasingSteerOptions {
  double settle = 2.0;    ///< [s]
  double fit_from = 0.5;  ///< [m/s^2]
  double fit_to = 4.0;    ///< [m/s^2]
};

/// ISO 7401: step input of the steering from straight-ahead driving.
struct StepSteerOptions {
  double steady = 1.0;  ///< averaging window of the steady state, at the end of the run [s], > 0
};

/// ISO 19365 (FMVSS 126): sine with dwell.
struct SineWithDwellTestOptions {};

/// ISO 3888: double lane change between the gates of the plan.
struct LaneChangeOptions {};

/// ISO 21994 straight ahead, ISO 7975 in a turn: braking.
struct BrakingTestOptions {
  double to_speed = 0.0;  ///< final speed of the braking distance [m/s], >= 0
};

/// The response to an ice patch, split friction or a gust.
struct DisturbanceOptions {
  double at = 1.0;               ///< time of the disturbance; reference of the deviations [s]
  double yaw_rate_bound = 0.02;  ///< recovered once the yaw rate stays below this [rad/s], > 0
};

/// The selected maneuver, with its options.
using ManeuverOptions = std::variant<SteadyStateCircleOptions, SlowlyIncreasingSteerOptions,
                                     StepSteerOptions, SineWithDwellTestOptions, LaneChangeOptions,
                                     BrakingTestOptions, DisturbanceOptions>;

struct ManeuverEntry {
  const char* name;
  const char* summary;
  ManeuverOptions defaults;
};

/// All maneuvers.
const std::vector<ManeuverEntry>& Maneuvers();

/// The name of the maneuver that `options` belong to.
const char* ManeuverName(const ManeuverOptions& options);

}  // namespace trackbed
