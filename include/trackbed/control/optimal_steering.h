#pragma once

#include <cstdint>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/optimize/search.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"

/// Steering found by a search at every control step (Skackauskas et al. 2017). The primary model is
/// the reference motion; the car, the secondary model, is disturbed. While the car's deviation (9)
/// from the primary stays within a limit, now and over the horizon, the plan's curvature is
/// steered. Otherwise the search finds the angle that minimizes the cost
///   (1)  F = (x_i - x_i0)^2 + (y_i - y_i0)^2 + (psi_i - psi_i0)^2,  (2)  |delta| <= delta_max
/// for the predicted poses of car and primary.
///
/// Symbols: q_i = (x_i, y_i, psi_i) pose of the car, q_i0 that of the primary; delta steering
/// [rad], positive to the left; S horizon [m]; v speed of the car, v_0 of the primary [m/s].
namespace trackbed {

/// The pose of the primary with which the car's pose is compared.
enum class Matching {
  kArcLength,  ///< At the car's station; the predicted pose is S meters ahead.
  /// At the same time, for any distance between the two: the published first stage.
  kTime,
};

/// Weights of the weighted cost (1): w_position (x_e^2 + y_e^2) + w_heading psi_e^2.
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

/// The weighted cost (1) of a deviation; `deviation_limit` bounds its square root.
double DeviationCost(const Deviation& deviation, const DeviationWeights& weights);

/// The options of the controller. `search.evaluations` = 0 selects ControlEvaluations. Random
/// searches draw the same numbers at every update.
struct OptimalSteeringOptions {
  Matching matching = Matching::kArcLength;
  /// Shortest horizon S of the primary [m], > 0; by default the distance of PreviewOptions. With
  /// kTime the car's horizon is S v/v_0. With kArcLength, S is at least 1.5 cbrt(e L v/omega) for a
  /// car with the offset e from its path, as in PreviewOptions.
  std::optional<double> horizon;
  /// Lower bound on S as a time [s], >= 0: S is at least time |v|, with kTime time v_0.
  double time = 0.0;
  SearchOptions search{.method = SearchMethod::kNelderMead, .population = 20, .tolerance = 1e-6};
  DeviationWeights weights;
  /// Limit epsilon on the norm of the deviation. Within the limit, the plan's curvature is steered.
  double deviation_limit = 0.01;
  std::optional<double> max_steering;  ///< delta_max [rad], > 0; default and at most the car's.
};
void Visit(KeyVisitor& keys, OptimalSteeringOptions& options);

/// The default number of evaluations per update: 60 for a search that converges, 600 for a search
/// that draws random numbers.
int ControlEvaluations(SearchMethod method);

/// The pose that the rear axle of a kinematic car reaches from the origin, heading along x, over
/// `distance` [m] (< 0: backwards) at `speed` [m/s] > 0, while its actuator turns from `steering`
/// to `wanted` [rad] at its rate and stays there. The heading and the arc have a closed form; the
/// ramp is integrated by quadrature. The error is below 1e-9 m if the ramp turns the car by less
/// than 2 rad. Cost: 0.5 us.
Pose2 PredictPose(const VehicleParams& vehicle, double steering, double wanted, double speed,
                  double distance);

/// The result of a search.
struct SteeringMatch {
  double steering = 0.0;  ///< Best steering angle [rad].
  double cost = 0.0;      ///< Weighted cost (1) at that angle.
  int evaluations = 0;
};

/// A target pose to reach over a distance.
struct SteeringProblem {
  /// Target pose of the rear axle, in the frame of the car's rear axle; the yaw is not wrapped.
  Pose2 wanted;
  double distance = 0.0;      ///< Distance to drive [m], not 0, < 0 backwards.
  double speed = 0.0;         ///< Speed of the car [m/s], > 0.
  double steering = 0.0;      ///< Present angle of the actuator [rad].
  double max_steering = 0.0;  ///< Largest angle delta_max [rad], > 0.
  double start = 0.0;         ///< Angle at which the search begins [rad].
};

/// The deviation from the target pose, in the car's axes, that results from `steering` [rad].
Deviation DeviationAhead(const VehicleParams& vehicle, const SteeringProblem& problem,
                         double steering);

/// The search variable: the fraction q of the heading change that can be reached by turning the
/// wheels at their full rate from their present angle (q = +-1). With R the angle by which the
/// wheels can turn,
///   delta = delta_now +- R (1 - sqrt(1 - abs(q))).
/// The reached pose is nearly linear in q, but not in delta. An angle that is reached late has
/// almost no effect, so a search over delta would stall on that plateau.
double SteeringOfShare(const VehicleParams& vehicle, const SteeringProblem& problem, double share);
/// The inverse of SteeringOfShare; returns +-1 for angles that are out of reach.
double TurnShare(const VehicleParams& vehicle, const SteeringProblem& problem, double steering);

/// Finds the angle whose end pose is nearest to the target, within delta_max. Angles that the
/// actuator cannot reach over the distance are not searched. The mirrored problem has exactly the
/// mirrored solution. InternalError for invalid options.
SteeringMatch SearchSteering(const VehicleParams& vehicle, const SteeringProblem& problem,
                             const DeviationWeights& weights, const SearchOptions& search);

/// The experiment of Skackauskas et al. 2017: the primary drives one lap at a constant angle, the
/// car at another constant angle and another speed. Both cars begin at the same pose with their
/// wheels already turned. The end poses are compared: with kTime after the duration of the lap,
/// with kArcLength after equal distances.
struct CircleExperiment {
  double primary_steering = 0.0;  ///< Constant steering of the primary [rad], not 0.
  double primary_speed = 0.0;     ///< Speed v_0 of the primary's reference point [m/s], > 0.
  double speed = 0.0;             ///< Speed v of the car's reference point [m/s], > 0.
  double max_steering = 0.0;      ///< Largest angle delta_max [rad].
  Matching matching = Matching::kArcLength;
  ReferencePoint reference = ReferencePoint::kCenterOfGravity;
};

/// The constant angle within +-delta_max that minimizes (1) of the experiment, weights 1.
SteeringMatch MatchSteering(const VehicleParams& vehicle, const CircleExperiment& experiment,
                            const SearchOptions& search, std::uint64_t seed);

/// The controller `optimal_steering`.
ControllerEntry OptimalSteering();

}  // namespace trackbed
