#pragma once

#include <variant>
#include <vector>

/// The standard maneuvers of vehicle dynamics: how a run is evaluated. What is steered and braked
/// is the controller's; a maneuver says what is read off the drive.
namespace trackbed {

/// ISO 4138: steady-state circular driving test. Samples count after `settle`, where the yaw rate
/// changes slowly; gradients are least squares over those with fit_from <= |a_y| <= fit_to.
struct SteadyStateCircleOptions {
  double settle = 2.0;    ///< [s]
  double fit_from = 0.5;  ///< [m/s^2]
  double fit_to = 4.0;    ///< [m/s^2]
};

/// SAE J266, method 2: slowly increasing steer at constant speed; the same numbers, and the
/// steering at 0.3 g.
struct SlowlyIncreasingSteerOptions {
  double settle = 2.0;    ///< [s]
  double fit_from = 0.5;  ///< [m/s^2]
  double fit_to = 4.0;    ///< [m/s^2]
};

/// ISO 7401: step input of the steering from straight-ahead driving.
struct StepSteerOptions {
  double steady = 1.0;  ///< the steady state is the mean over the last so many seconds [s], > 0
};

/// ISO 19365 (FMVSS 126): sine with dwell.
struct SineWithDwellTestOptions {};

/// ISO 3888: double lane change between the gates of the plan.
struct LaneChangeOptions {};

/// ISO 21994 straight ahead, ISO 7975 in a turn: braking.
struct BrakingTestOptions {
  double to_speed = 0.0;  ///< the braking distance ends here [m/s], >= 0
};

/// What an ice patch, split friction or a gust does to the car.
struct DisturbanceOptions {
  double at = 1.0;               ///< the course held then is what is departed from [s]
  double yaw_rate_bound = 0.02;  ///< below it for good, the car has recovered [rad/s], > 0
};

/// Which alternative it holds says which maneuver is meant.
using ManoeuvreOptions = std::variant<SteadyStateCircleOptions, SlowlyIncreasingSteerOptions,
                                      StepSteerOptions, SineWithDwellTestOptions, LaneChangeOptions,
                                      BrakingTestOptions, DisturbanceOptions>;

struct ManoeuvreEntry {
  const char* name;
  const char* summary;
  ManoeuvreOptions defaults;
};

/// Every maneuver there is.
const std::vector<ManoeuvreEntry>& Manoeuvres();

/// The name of the maneuver that `options` belong to.
const char* ManoeuvreName(const ManoeuvreOptions& options);

}  // namespace trackbed
