#pragma once

#include <variant>
#include <vector>

/// The standard maneuvers of vehicle dynamics. A maneuver determines which metrics of a run are
/// computed; steering and braking are the task of the controller.
namespace trackbed {

/// ISO 4138: steady-state circular driving test. The evaluation uses samples that are later than
/// `settle` and have a slowly changing yaw rate. Gradients over the lateral acceleration a_y are
/// least-squares fits to the samples with fit_from <= |a_y| <= fit_to.
struct SteadyStateCircleOptions {
  double settle = 2.0;    ///< Settling time before the evaluation [s].
  double fit_from = 0.5;  ///< Smallest lateral acceleration |a_y| of fitted samples [m/s^2].
  double fit_to = 4.0;    ///< Largest lateral acceleration |a_y| of fitted samples [m/s^2].
};

/// SAE J266, method 2: slowly increasing steer at constant speed. The metrics of slowly increasing
/// steer are those of the steady-state circular test, plus the steering angle at a lateral
/// acceleration of 0.3 g.
struct SlowlyIncreasingSteerOptions {
  double settle = 2.0;    ///< Settling time before the evaluation [s].
  double fit_from = 0.5;  ///< Smallest lateral acceleration |a_y| of fitted samples [m/s^2].
  double fit_to = 4.0;    ///< Largest lateral acceleration |a_y| of fitted samples [m/s^2].
};

/// ISO 7401: a step of the steering angle while driving straight ahead.
struct StepSteerOptions {
  /// Duration at the end of the run over which the steady state is averaged [s], > 0.
  double steady = 1.0;
};

/// ISO 19365 (FMVSS 126): sine with dwell.
struct SineWithDwellTestOptions {};

/// ISO 3888: double lane change between the gates that the plan defines.
struct LaneChangeOptions {};

/// ISO 21994 (braking straight ahead) and ISO 7975 (braking in a turn).
struct BrakingTestOptions {
  /// Speed of the car at which the measurement of the braking distance ends [m/s], >= 0.
  double to_speed = 0.0;
};

/// Evaluates the response to an ice patch, split friction or a gust.
struct DisturbanceOptions {
  double at = 1.0;  ///< Time at which the disturbance begins [s].
  /// Bound on the deviation of the yaw rate [rad/s], > 0. The car has recovered when the deviation
  /// of the yaw rate stays below this bound.
  double yaw_rate_bound = 0.02;
};

/// The selected maneuver and the options of this maneuver.
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

/// Returns the name of the maneuver to which the options belong.
const char* ManeuverName(const ManeuverOptions& options);

}  // namespace trackbed
