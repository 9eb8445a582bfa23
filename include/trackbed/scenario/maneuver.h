#pragma once

#include <variant>
#include <vector>

/// The standard maneuvers of vehicle dynamics, which determine how a run is evaluated. The
/// controller steers and brakes; a maneuver defines what is measured.
namespace trackbed {

/// ISO 4138: steady-state circular driving test. The evaluation uses samples after `settle` at
/// which the yaw rate changes slowly. Gradients are least-squares fits to the samples with fit_from
/// <= |a_y| <= fit_to.
struct SteadyStateCircleOptions {
  double settle = 2.0;    ///< Settling time [s].
  double fit_from = 0.5;  ///< Smallest |a_y| of the fit [m/s^2].
  double fit_to = 4.0;    ///< Largest |a_y| of the fit [m/s^2].
};

/// SAE J266, method 2: slowly increasing steer at constant speed. The metrics are those of the
/// steady-state circle, and the steering angle at 0.3 g.
struct SlowlyIncreasingSteerOptions {
  double settle = 2.0;    ///< Settling time [s].
  double fit_from = 0.5;  ///< Smallest |a_y| of the fit [m/s^2].
  double fit_to = 4.0;    ///< Largest |a_y| of the fit [m/s^2].
};

/// ISO 7401: step input of the steering from straight-ahead driving.
struct StepSteerOptions {
  /// Length of the window at the end of the run over which the steady state is averaged [s], > 0.
  double steady = 1.0;
};

/// ISO 19365 (FMVSS 126): sine with dwell.
struct SineWithDwellTestOptions {};

/// ISO 3888: double lane change between the gates of the plan.
struct LaneChangeOptions {};

/// ISO 21994 (braking straight ahead) and ISO 7975 (braking in a turn).
struct BrakingTestOptions {
  double to_speed = 0.0;  ///< Speed at which the braking distance ends [m/s], >= 0.
};

/// Evaluates the response to an ice patch, split friction or a gust.
struct DisturbanceOptions {
  double at = 1.0;  ///< Time of the disturbance [s].
  /// Bound on the yaw rate deviation [rad/s], > 0. The car has recovered when the deviation stays
  /// below the bound.
  double yaw_rate_bound = 0.02;
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

/// The name of the maneuver that has these options.
const char* ManeuverName(const ManeuverOptions& options);

}  // namespace trackbed
