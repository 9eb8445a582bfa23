#include "trackbed/control/optimal_steering.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "src/control/control_keys.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/steering_actuator.h"

namespace trackbed {
namespace {

/// Bounds and initial value of the search for one steering parameter.
struct SteeringInterval {
  double lower = 0.0;
  double upper = 0.0;
  double start = 0.0;
};

/// Returns the largest angle [rad] by which the wheels can turn while the car drives the distance
/// given in `problem`.
double Reach(const VehicleParams& vehicle, const SteeringProblem& problem) {
  return vehicle.steering_rate * std::abs(problem.distance) / problem.speed;
}

/// Subtracts two poses component by component in the world frame, since the cost does not depend on
/// the direction of the axes.
Deviation Difference(const Pose2& actual, const Pose2& wanted) {
  return {actual.x - wanted.x, actual.y - wanted.y, actual.yaw - wanted.yaw};
}

/// Finds the steering value that minimizes `cost`. The field `steering` of the result holds the
/// minimizing value.
template <typename Cost>
SteeringMatch Minimize(const Cost& cost, const SteeringInterval& range, const SearchOptions& search,
                       std::uint64_t seed) {
  const SearchProblem problem{.lower = {range.lower},
                              .upper = {range.upper},
                              .start = {range.start},
                              .objective = [&](std::span<const double> x) { return cost(x[0]); },
                              .constraint_count = 0,
                              .constraints = {}};
  const SearchResult result = Search(problem, search, seed);
  TRACKBED_CHECK(result.ok(), "a search for steering ended {}", ToString(result.status));
  return {result.x[0], result.value, result.evaluations};
}

}  // namespace

Deviation ComputeDeviation(const Pose2& actual, const Pose2& wanted) {
  const Vec2 offset = ToLocal(wanted, actual.position());
  return {offset.x(), offset.y(), actual.yaw - wanted.yaw};
}

double DeviationCost(const Deviation& deviation, const DeviationWeights& weights) {
  return weights.position * (deviation.x * deviation.x + deviation.y * deviation.y) +
         weights.heading * deviation.yaw * deviation.yaw;
}

int ControlEvaluations(SearchMethod method) {
  return SearchFor(method).random ? 600 : 60;
}

Pose2 PredictPose(const VehicleParams& vehicle, double steering, double wanted, double speed,
                  double distance) {
  const SteeringMove move =
      MoveSteering({vehicle.steering_limit, vehicle.steering_rate}, steering, wanted);
  const double direction = std::copysign(1.0, distance);
  const double ramp = std::min(speed * move.ramp_time, std::abs(distance));
  Pose2 pose;
  if (ramp > 0.0) {
    // The heading is the integral of tan(delta)/L over s, where the steering angle delta = delta_0
    // + slope s changes linearly with the distance s.
    const double slope = move.rate / speed;
    const double cosine = std::cos(steering);
    const auto heading = [&](double s) {
      return direction * std::log(cosine / std::cos(steering + slope * s)) /
             (vehicle.wheelbase * slope);
    };
    // Use the same quadrature nodes for the integrals of both coordinates x and y.
    using Quadrature = boost::math::quadrature::gauss<double, 10>;
    const double half = 0.5 * ramp;
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = 0; i < Quadrature::abscissa().size(); ++i) {
      const double node = half * Quadrature::abscissa()[i];
      sum += Quadrature::weights()[i] *
             (Direction(heading(half - node)) + Direction(heading(half + node)));
    }
    pose = {direction * half * sum.x(), direction * half * sum.y(), heading(ramp)};
  }
  const double held = direction * (std::abs(distance) - ramp);
  return held == 0.0 ? pose : MoveOnArc(pose, held, held * CurvatureForSteering(vehicle, move.end));
}

Deviation DeviationAhead(const VehicleParams& vehicle, const SteeringProblem& problem,
                         double steering) {
  return Difference(
      PredictPose(vehicle, problem.steering, steering, problem.speed, problem.distance),
      problem.wanted);
}

double SteeringOfShare(const VehicleParams& vehicle, const SteeringProblem& problem, double share) {
  return problem.steering +
         std::copysign(Reach(vehicle, problem) * (1.0 - std::sqrt(1.0 - std::abs(share))), share);
}

double TurnShare(const VehicleParams& vehicle, const SteeringProblem& problem, double steering) {
  const double turn =
      std::clamp((steering - problem.steering) / Reach(vehicle, problem), -1.0, 1.0);
  const double left = 1.0 - std::abs(turn);
  return std::copysign(1.0 - left * left, turn);
}

SteeringMatch SearchSteering(const VehicleParams& vehicle, const SteeringProblem& problem,
                             const DeviationWeights& weights, const SearchOptions& search) {
  // Mirrors the problem if the wanted pose is on the right. Mirrored problems then have exactly
  // mirrored solutions.
  const Pose2& wanted = problem.wanted;
  const bool ahead = wanted.y == 0.0 && wanted.yaw == 0.0;
  const bool mirrored =
      wanted.y < 0.0 || (wanted.y == 0.0 && wanted.yaw < 0.0) || (ahead && problem.steering < 0.0);
  const double side = mirrored ? -1.0 : 1.0;
  SteeringProblem own = problem;
  own.wanted = {wanted.x, side * wanted.y, side * wanted.yaw};
  own.steering = side * problem.steering;

  const double limit = problem.max_steering;
  const double lower = TurnShare(vehicle, own, -limit);
  const double upper = TurnShare(vehicle, own, limit);
  // Start the search inside the bounds, because a simplex search that starts on a bound gets stuck
  // if its second point has a higher cost.
  const double margin = 0.05 * (upper - lower);
  const double start =
      std::clamp(TurnShare(vehicle, own, side * problem.start), lower + margin, upper - margin);
  const auto cost = [&](double share) {
    return DeviationCost(DeviationAhead(vehicle, own, SteeringOfShare(vehicle, own, share)),
                         weights);
  };
  // Constant seed of the random numbers, so that every update uses the same numbers.
  constexpr std::uint64_t kSeed = 1;
  SteeringMatch match = Minimize(cost, {lower, upper, start}, search, kSeed);
  match.steering = side * std::clamp(SteeringOfShare(vehicle, own, match.steering), -limit, limit);
  return match;
}

SteeringMatch MatchSteering(const VehicleParams& vehicle, const CircleExperiment& experiment,
                            const SearchOptions& search, std::uint64_t seed) {
  // Returns the final pose of a car that drives for `time` with constant steering and speed.
  const auto drive = [&](double steering, double speed, double time) {
    KinematicCar car(vehicle, experiment.reference, {.speed = speed, .steering = steering});
    car.Step({.steering = steering}, time);
    return car.state().pose;
  };
  const double yaw_rate = drive(experiment.primary_steering, experiment.primary_speed, 1.0).yaw;
  const double lap = 2.0 * kPi / std::abs(yaw_rate);  // [s]
  const bool by_time = experiment.matching == Matching::kTime;
  const Pose2 wanted = drive(experiment.primary_steering,
                             by_time ? experiment.primary_speed : experiment.speed, lap);
  const auto cost = [&](double steering) {
    return DeviationCost(Difference(drive(steering, experiment.speed, lap), wanted), {});
  };
  return Minimize(cost, {-experiment.max_steering, experiment.max_steering, 0.0}, search, seed);
}

void Visit(KeyVisitor& keys, OptimalSteeringOptions& options) {
  static const EnumNames<Matching> matchings{{Matching::kArcLength, "arc_length"},
                                             {Matching::kTime, "time"}};
  keys.Field({"matching", "",
              "reference pose: at the car's station, or where the car should be at this time"},
             options.matching, Need::kOptional, matchings);
  keys.Field({"horizon", "m", "minimum prediction distance; default: from car, speed and path"},
             options.horizon, Range{.min = 0.1, .max = 1000.0});
  keys.Field(kAheadTime, options.time, Need::kOptional, kNonNegative);
  keys.Section(
      {"search", "",
       "search for the angle at each update; evaluations 0: 60, or 600 for isres, esch and crs2"},
      options.search);
  keys.Section({"weights", "", "weights of the deviation"}, options.weights);
  keys.Field({"deviation_limit", "",
              "weighted deviation (root of the sum of squares) up to which the plan's curvature is "
              "steered without a search"},
             options.deviation_limit, Need::kOptional, kNonNegative);
  keys.Field({"max_steering", "rad", "maximum steering angle; default: the car's limit"},
             options.max_steering, Range{.max = 1.5, .above = 0.0});
}

void Visit(KeyVisitor& keys, DeviationWeights& weights) {
  keys.Field({"position", "1/m^2", "weight of the squared position error"}, weights.position,
             Need::kOptional, kNonNegative);
  keys.Field({"heading", "1/rad^2", "weight of the squared heading error"}, weights.heading,
             Need::kOptional, kNonNegative);
}

}  // namespace trackbed
