#pragma once

#include <cstdint>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/optimize/search.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"

/// Steering controller that searches for the best steering angle at every control step (Skackauskas
/// et al. 2017). The primary model is the reference motion; the car, the secondary model, is
/// disturbed. While the car's deviation (9) from the primary is within a limit, now and over the
/// horizon, the controller commands the steering angle for the plan's curvature. Otherwise a search
/// finds the steering angle that minimizes the cost
///   (1)  F = (x_i - x_i0)^2 + (y_i - y_i0)^2 + (psi_i - psi_i0)^2,  (2)  |delta| <= delta_max
/// for the predicted poses of car and primary.
///
/// Symbols: q_i = (x_i, y_i, psi_i) pose of the car, q_i0 pose of the primary; delta steering
/// [rad], positive to the left; S horizon [m]; v speed of the car, v_0 of the primary [m/s].
namespace trackbed {

/// The pose of the primary with which the car's pose is compared.
enum class Matching {
  kArcLength,  ///< Pose of the primary at the car's station; the predicted pose is S meters ahead.
  /// Pose of the primary at the same time, however far away the car is: the first stage of the
  /// published method.
  kTime,
};

/// Weights of position and heading in the cost (1), which is w_position (x_e^2 + y_e^2) + w_heading
/// psi_e^2.
struct DeviationWeights {
  double position = 1.0;  ///< Weight of the position [1/m^2], >= 0.
  double heading = 1.0;   ///< Weight of the heading [1/rad^2], >= 0; not both 0.
};
void Visit(KeyVisitor& keys, DeviationWeights& weights);

/// The deviation (9): the pose of the car relative to the primary.
struct Deviation {
  double x = 0.0;    ///< Component along the primary's heading [m].
  double y = 0.0;    ///< Component to the primary's left [m].
  double yaw = 0.0;  ///< Heading difference [rad], not wrapped.
};

/// Computes the deviation q_e = R(psi_0)^T (q - q_0).
Deviation ComputeDeviation(const Pose2& actual, const Pose2& wanted);

/// Computes the weighted cost (1) of a deviation. The option `deviation_limit` is a limit on the
/// square root of this cost.
double DeviationCost(const Deviation& deviation, const DeviationWeights& weights);

/// The options of the controller `optimal_steering`. If `search.evaluations` is 0,
/// ControlEvaluations gives the number of evaluations. Random searches draw the same random numbers
/// at every update.
struct OptimalSteeringOptions {
  Matching matching = Matching::kArcLength;
  /// Shortest horizon S of the primary [m], > 0; by default the preview distance R of
  /// PreviewOptions. With kTime the car's horizon is S v/v_0. With kArcLength, S is at least 1.5
  /// cbrt(e L v/omega) for a car with the offset e from its path, as in PreviewOptions.
  std::optional<double> horizon;
  /// Lower bound on the horizon S as a time [s], >= 0: S is at least time |v|, or time v_0 with
  /// kTime.
  double time = 0.0;
  SearchOptions search{.method = SearchMethod::kNelderMead, .population = 20, .tolerance = 1e-6};
  DeviationWeights weights;
  /// Limit epsilon on the norm of the deviation. Within the limit, the controller steers by the
  /// plan's curvature and does not search.
  double deviation_limit = 0.01;
  std::optional<double> max_steering;  ///< Steering limit delta_max [rad], > 0; at most the car's
                                       ///< steering limit, which is the default.
};
void Visit(KeyVisitor& keys, OptimalSteeringOptions& options);

/// Returns the default number of cost evaluations per update: 60 for a deterministic search, 600
/// for a search that draws random numbers.
int ControlEvaluations(SearchMethod method);

/// Predicts the pose of a kinematic car's rear axle after `distance` [m] (< 0: backwards) at
/// `speed` [m/s] > 0. The car starts at the origin, heading along x. The steering angle changes
/// from `steering` to `wanted` [rad] at the actuator's maximum rate and then stays at `wanted`. The
/// heading, and the arc at constant steering, have closed forms. The position during the steering
/// ramp is integrated by quadrature. The position error is below 1e-9 m if the car turns by less
/// than 2 rad during the ramp. Cost: 0.5 us.
Pose2 PredictPose(const VehicleParams& vehicle, double steering, double wanted, double speed,
                  double distance);

/// The result of a search for a steering angle.
struct SteeringMatch {
  double steering = 0.0;  ///< Steering angle of lowest cost [rad].
  double cost = 0.0;      ///< Weighted cost (1) of this steering angle.
  int evaluations = 0;
};

/// The problem of SearchSteering: a target pose that the car is to reach after driving a distance.
struct SteeringProblem {
  /// Target pose of the rear axle, in the frame of the car's rear axle; the yaw is not wrapped.
  Pose2 wanted;
  double distance = 0.0;      ///< Distance to drive [m], not 0, < 0 backwards.
  double speed = 0.0;         ///< Speed of the car [m/s], > 0.
  double steering = 0.0;      ///< Present angle of the actuator [rad].
  double max_steering = 0.0;  ///< Largest angle delta_max [rad], > 0.
  double start = 0.0;         ///< Angle at which the search begins [rad].
};

/// Predicts the deviation from the target pose if the car steers to `steering` [rad], in the axes
/// of the car's present pose.
Deviation DeviationAhead(const VehicleParams& vehicle, const SteeringProblem& problem,
                         double steering);

/// Converts the search variable q = `share` to a steering angle delta. The variable q is a fraction
/// of the largest reachable heading change. At q = +-1, the wheels turn at their full rate over the
/// whole distance. With R the angle by which the wheels can turn over the distance,
///   delta = delta_now +- R (1 - sqrt(1 - abs(q))).
/// The reached pose is nearly linear in q, but not in delta. A steering angle that the wheels reach
/// only near the end of the distance has almost no effect on the pose, so a search over delta would
/// stall on a plateau.
double SteeringOfShare(const VehicleParams& vehicle, const SteeringProblem& problem, double share);
/// Inverse of SteeringOfShare: converts a steering angle to the search variable q. Returns +-1 for
/// angles that the wheels cannot reach.
double TurnShare(const VehicleParams& vehicle, const SteeringProblem& problem, double steering);

/// Finds the steering angle within delta_max whose end pose is nearest to the target pose. Skips
/// angles that the actuator cannot reach over the distance. A mirrored problem has exactly the
/// mirrored solution. Throws InternalError for invalid options.
SteeringMatch SearchSteering(const VehicleParams& vehicle, const SteeringProblem& problem,
                             const DeviationWeights& weights, const SearchOptions& search);

/// The experiment of Skackauskas et al. 2017: the primary drives one full circle at a constant
/// steering angle, and the car drives at another constant steering angle and another speed. Both
/// start at the same pose with their wheels already turned. The experiment compares their end
/// poses: with kTime after the duration of the circle, with kArcLength after equal distances.
struct CircleExperiment {
  double primary_steering = 0.0;  ///< Constant steering of the primary [rad], not 0.
  double primary_speed = 0.0;     ///< Speed v_0 of the primary's reference point [m/s], > 0.
  double speed = 0.0;             ///< Speed v of the car's reference point [m/s], > 0.
  double max_steering = 0.0;      ///< Largest angle delta_max [rad].
  Matching matching = Matching::kArcLength;
  ReferencePoint reference = ReferencePoint::kCenterOfGravity;
};

/// Finds the car's constant steering angle within +-delta_max that minimizes the cost (1) in the
/// circle experiment, with both weights equal to 1.
SteeringMatch MatchSteering(const VehicleParams& vehicle, const CircleExperiment& experiment,
                            const SearchOptions& search, std::uint64_t seed);

/// Returns the registry entry of the controller `optimal_steering`.
ControllerEntry OptimalSteering();

}  // namespace trackbed
