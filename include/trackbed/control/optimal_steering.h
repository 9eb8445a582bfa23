#pragma once

#include <cstdint>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/optimize/search.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"

/// Steering controller that searches for the best steering angle at every control step (Skackauskas
/// et al. 2017). The primary model (short: primary) moves along the reference motion. The secondary
/// model is the car, which is subject to disturbances. While the car's deviation (9) from the
/// primary is within a limit, now and over the horizon, the controller commands the steering angle
/// for the plan's curvature. If the deviation exceeds the limit, a search finds the steering angle
/// that minimizes the cost (1) for the predicted poses of car and primary:
///   (1)  F = (x_i - x_i0)^2 + (y_i - y_i0)^2 + (psi_i - psi_i0)^2,  (2)  |delta| <= delta_max.
///
/// Symbols: q_i = (x_i, y_i, psi_i) pose of the car, q_i0 pose of the primary; delta steering angle
/// [rad], positive to the left; S horizon [m]; v speed of the car, v_0 of the primary [m/s].
namespace trackbed {

/// Selects the pose of the primary with which the car's pose is compared.
enum class Matching {
  /// Pose of the primary at the car's station. The car's predicted pose is compared with the
  /// primary's pose S meters ahead of the car's station.
  kArcLength,
  /// Pose of the primary at the same time, however far the car is from the primary. The comparison
  /// at equal times is the first stage of the published method.
  kTime,
};

/// Weights of the position error (x_e, y_e) and the heading error psi_e in the cost (1), which is
/// w_position (x_e^2 + y_e^2) + w_heading psi_e^2.
struct DeviationWeights {
  double position = 1.0;  ///< Weight w_position of the position error [1/m^2], >= 0.
  /// Weight w_heading of the heading error [1/rad^2], >= 0; only one of the two weights may be 0.
  double heading = 1.0;
};
void Visit(KeyVisitor& keys, DeviationWeights& weights);

/// The deviation (9), which is the pose of the car relative to the primary.
struct Deviation {
  double x = 0.0;    ///< Component of the car's deviation along the primary's heading [m].
  double y = 0.0;    ///< Component of the car's deviation to the primary's left [m].
  double yaw = 0.0;  ///< Heading of the car minus heading of the primary [rad], not wrapped.
};

/// Computes the deviation q_e = R(psi_0)^T (q - q_0) of the pose q from the pose q_0, with the
/// rotation matrix R.
Deviation ComputeDeviation(const Pose2& actual, const Pose2& wanted);

/// Computes the weighted cost (1) of a deviation. The option `deviation_limit` limits the square
/// root of the weighted cost.
double DeviationCost(const Deviation& deviation, const DeviationWeights& weights);

/// The options of the controller `optimal_steering`. If `search.evaluations` is 0,
/// ControlEvaluations determines the number of cost evaluations. Search methods that use random
/// numbers draw the same numbers at every update.
struct OptimalSteeringOptions {
  Matching matching = Matching::kArcLength;
  /// Shortest horizon S of the primary [m], > 0; by default the preview distance R of
  /// PreviewOptions. With kTime, the horizon of the car is S v/v_0, with the speeds v of the car
  /// and v_0 of the primary. With kArcLength, the horizon S is at least 1.5 cbrt(e L v/omega) for a
  /// car with the offset e from its path, as in PreviewOptions.
  std::optional<double> horizon;
  /// Minimum time that the horizon covers [s], >= 0. The length S of the horizon is at least the
  /// minimum time multiplied by the speed of the car (kArcLength) or of the primary (kTime).
  double time = 0.0;
  SearchOptions search{.method = SearchMethod::kNelderMead, .population = 20, .tolerance = 1e-6};
  DeviationWeights weights;
  /// Limit epsilon on the weighted norm of the deviation between car and primary. While the
  /// deviation between car and primary is within the limit, the controller steers by the plan's
  /// curvature and does not search.
  double deviation_limit = 0.01;
  /// Maximum steering angle delta_max of the search [rad], > 0. The default and upper bound of
  /// delta_max is the car's steering limit.
  std::optional<double> max_steering;
};
void Visit(KeyVisitor& keys, OptimalSteeringOptions& options);

/// Returns the default number of cost evaluations per update: 60 for a deterministic search, 600
/// for a search that draws random numbers.
int ControlEvaluations(SearchMethod method);

/// Predicts the pose of a kinematic car's rear axle after `distance` [m] (< 0: backwards) at
/// `speed` [m/s] > 0. In the prediction, the car starts at the origin, heading along x. The
/// steering angle changes from `steering` to `wanted` [rad] at the actuator's maximum rate and then
/// stays at `wanted`. The predicted heading, and the arc at constant steering, are computed in
/// closed form. While the steering angle changes, the position is integrated by quadrature. The
/// position error of the prediction is below 1e-9 m if the car turns by less than 2 rad while the
/// steering angle changes. Cost: 0.5 us.
Pose2 PredictPose(const VehicleParams& vehicle, double steering, double wanted, double speed,
                  double distance);

/// The result of the search for the best steering angle.
struct SteeringMatch {
  double steering = 0.0;  ///< Steering angle with the lowest cost found [rad].
  double cost = 0.0;      ///< Weighted cost (1) of the found steering angle.
  int evaluations = 0;
};

/// The problem that SearchSteering solves: a target pose that the car is to reach after driving a
/// given distance.
struct SteeringProblem {
  /// Target pose of the rear axle, relative to the present pose of the rear axle; the yaw is not
  /// wrapped.
  Pose2 wanted;
  double distance = 0.0;      ///< Distance to drive [m], not 0; negative for driving backwards.
  double speed = 0.0;         ///< Speed of the car [m/s], > 0.
  double steering = 0.0;      ///< Present angle of the steering actuator [rad].
  double max_steering = 0.0;  ///< Largest steering angle delta_max [rad], > 0.
  double start = 0.0;  ///< Steering angle at which the search for the best angle begins [rad].
};

/// Predicts the deviation of the car from the target pose if the car steers to the angle `steering`
/// [rad]. The deviation is given in the axes of the car's present pose.
Deviation DeviationAhead(const VehicleParams& vehicle, const SteeringProblem& problem,
                         double steering);

/// Converts the search variable q = `share` to a steering angle delta. The search variable q is a
/// fraction of the largest reachable heading change. At q = +-1, the wheels turn at their full rate
/// over the whole distance to drive. With the present angle delta_now and the angle R by which the
/// wheels can turn over the distance to drive, the steering angle is
///   delta = delta_now +- R (1 - sqrt(1 - abs(q))).
/// The pose that the car reaches is nearly linear in the search variable q, but not in the steering
/// angle delta. A steering angle that the wheels reach only near the end of the distance has almost
/// no effect on the end pose. A search over the steering angle would stall on this plateau of the
/// cost.
double SteeringOfShare(const VehicleParams& vehicle, const SteeringProblem& problem, double share);
/// Converts a steering angle to the search variable q; the inverse of SteeringOfShare. Returns q =
/// +-1 for steering angles that the wheels cannot reach.
double TurnShare(const VehicleParams& vehicle, const SteeringProblem& problem, double steering);

/// Finds the steering angle within delta_max whose end pose is nearest to the target pose. The
/// search skips steering angles that the actuator cannot reach over the distance to drive. The
/// solution of a mirrored problem is exactly the mirrored solution. Throws InternalError if the
/// search options are invalid.
SteeringMatch SearchSteering(const VehicleParams& vehicle, const SteeringProblem& problem,
                             const DeviationWeights& weights, const SearchOptions& search);

/// The circle experiment of Skackauskas et al. 2017. The primary model drives one full circle at a
/// constant steering angle, and the car drives at another constant steering angle and another
/// speed. The primary model and the car start at the same pose with their wheels already turned.
/// The experiment compares the end poses of the primary model and the car. With kTime, the poses
/// are compared after the duration of the circle; with kArcLength, after equal distances.
struct CircleExperiment {
  double primary_steering = 0.0;  ///< Constant steering angle of the primary [rad], not 0.
  double primary_speed = 0.0;     ///< Speed v_0 of the primary's reference point [m/s], > 0.
  double speed = 0.0;             ///< Speed v of the car's reference point [m/s], > 0.
  double max_steering = 0.0;      ///< Largest steering angle delta_max of the car [rad].
  Matching matching = Matching::kArcLength;
  ReferencePoint reference = ReferencePoint::kCenterOfGravity;
};

/// Finds the car's constant steering angle within +-delta_max that minimizes the cost (1) in the
/// circle experiment, with both weights equal to 1.
SteeringMatch MatchSteering(const VehicleParams& vehicle, const CircleExperiment& experiment,
                            const SearchOptions& search, std::uint64_t seed);

}  // namespace trackbed
