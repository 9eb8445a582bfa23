#include "trackbed/vehicle/steering_schedule.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Target of the steering angle that applies from the driven distance `distance` on.
struct Target {
  double distance;
  double steering;
  double slope;
};

std::vector<Target> SteeringTargets(const std::vector<TurnSteering>& turns,
                                    const std::vector<double>& slopes, double neutral) {
  std::vector<Target> targets;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const TurnSteering& turn = turns[k];
    TRACKBED_CHECK(turn.end > turn.start && turn.start >= (k == 0 ? 0.0 : turns[k - 1].start),
                   "turn {} from {} m to {} m is out of order", k, turn.start, turn.end);
    TRACKBED_REQUIRE(std::isfinite(turn.steering) && std::isfinite(neutral),
                     "SteeringSchedule: steering {} and {} rad; must be finite", turn.steering,
                     neutral);
    targets.push_back({turn.start, turn.steering, slopes[k]});
    // If the steering transitions of two turns overlap, the later turn takes precedence and ends
    // the earlier turn.
    if (k + 1 == turns.size() || turn.end < turns[k + 1].start) {
      targets.push_back({turn.end, neutral, slopes[k]});
    }
  }
  return targets;
}

}  // namespace

SteeringSchedule::SteeringSchedule(const std::vector<TurnSteering>& turns, double slope,
                                   double neutral)
    : SteeringSchedule(turns, std::vector<double>(turns.size(), slope), neutral) {}

SteeringSchedule::SteeringSchedule(const std::vector<TurnSteering>& turns,
                                   const std::vector<double>& slopes, double neutral) {
  TRACKBED_CHECK(slopes.size() == turns.size(), "{} slopes for {} turns", slopes.size(),
                 turns.size());
  if (turns.empty() && neutral != 0.0) {
    knots_.push_back({0.0, neutral});
  }
  const std::vector<Target> targets = SteeringTargets(turns, slopes, neutral);
  double steering = neutral;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto& [begin, target, slope] = targets[i];
    TRACKBED_CHECK(slope > 0.0, "slope {}", slope);
    const double until =
        i + 1 < targets.size() ? targets[i + 1].distance : std::numeric_limits<double>::infinity();
    if (knots_.empty() || begin > knots_.back().distance) {
      knots_.push_back({begin, steering});
    }
    const double ramp = std::abs(target - steering) / slope;
    if (ramp == 0.0) {
      continue;
    }
    if (begin + ramp <= until) {
      steering = target;
      knots_.push_back({begin + ramp, steering});
    } else {
      steering += std::copysign(slope * (until - begin), target - steering);
      knots_.push_back({until, steering});
    }
  }
}

SteeringSchedule SteeringSchedule::Through(std::vector<Knot> knots) {
  TRACKBED_CHECK(!knots.empty(), "no knots");
  for (const Knot& knot : knots) {
    TRACKBED_REQUIRE(std::isfinite(knot.distance) && std::isfinite(knot.steering),
                     "SteeringSchedule: a knot at {} m of {} rad; must be finite", knot.distance,
                     knot.steering);
  }
  for (std::size_t i = 1; i < knots.size(); ++i) {
    TRACKBED_CHECK(knots[i].distance > knots[i - 1].distance, "knots at {} and {} m do not rise",
                   knots[i - 1].distance, knots[i].distance);
  }
  SteeringSchedule schedule;
  schedule.knots_ = std::move(knots);
  return schedule;
}

SteeringSchedule SteeringSchedule::Constant(double steering) {
  SteeringSchedule schedule;
  schedule.knots_.push_back({0.0, steering});
  return schedule;
}

double SteeringSchedule::At(double distance) const {
  if (std::isnan(distance)) {
    return distance;
  }
  if (knots_.empty()) {
    return 0.0;
  }
  const auto after =
      std::upper_bound(knots_.begin(), knots_.end(), distance,
                       [](double value, const Knot& knot) { return value < knot.distance; });
  if (after == knots_.begin()) {
    return knots_.front().steering;
  }
  if (after == knots_.end()) {
    return knots_.back().steering;
  }
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  return std::lerp(a.steering, b.steering, (distance - a.distance) / (b.distance - a.distance));
}

SteeringSchedule SteeringSchedule::From(double distance) const {
  SteeringSchedule rest = Constant(At(distance));
  for (const Knot& knot : knots_) {
    if (knot.distance > distance) {
      rest.knots_.push_back({knot.distance - distance, knot.steering});
    }
  }
  return rest;
}

namespace {
constexpr double kMaxRampLength = 1e6;  // [m]
}  // namespace

double SteeringDistance(const VehicleParams& params, double steering, double speed) {
  return speed * std::abs(steering) / params.steering_rate;
}

double RampHeading(const VehicleParams& params, double steering, double speed) {
  const double scale = speed / (params.wheelbase * params.steering_rate);
  return std::copysign(scale * -std::log(std::cos(steering)), steering);
}

Pose2 RampPose(const VehicleParams& params, double steering, double speed) {
  const double distance = SteeringDistance(params, steering, speed);
  TRACKBED_REQUIRE(distance <= kMaxRampLength,
                   "RampPose: a ramp of {} m to {} rad at {} m/s; must be "
                   "at most {} m",
                   distance, steering, speed, kMaxRampLength);
  if (distance == 0.0) {
    return {};
  }
  const auto heading = [&](double s) {
    return RampHeading(params, steering * (s / distance), speed);
  };
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  constexpr unsigned kDepth = 5;
  constexpr double kPrecision = 1e-14;
  return {Quadrature::integrate([&](double s) { return std::cos(heading(s)); }, 0.0, distance,
                                kDepth, kPrecision),
          Quadrature::integrate([&](double s) { return std::sin(heading(s)); }, 0.0, distance,
                                kDepth, kPrecision),
          heading(distance)};
}

KinematicState RollOut(const VehicleParams& params, const KinematicState& start,
                       const SteeringSchedule& schedule, double distance, double step,
                       ReferencePoint reference) {
  return RollOut(params, start, schedule, std::vector<double>{distance}, step, reference).front();
}

std::vector<KinematicState> RollOut(const VehicleParams& params, const KinematicState& start,
                                    const SteeringSchedule& schedule,
                                    const std::vector<double>& distances, double step,
                                    ReferencePoint reference) {
  TRACKBED_CHECK(start.speed != 0.0 && step > 0.0, "speed {}, step {}", start.speed, step);
  const int direction = start.speed > 0.0 ? 1 : -1;
  KinematicState state = start;
  const std::vector<SteeringSchedule::Knot>& knots = schedule.knots();
  auto knot = knots.begin();
  double done = 0.0;
  std::vector<KinematicState> states;
  states.reserve(distances.size());
  for (const double distance : distances) {
    TRACKBED_REQUIRE(std::isfinite(distance), "RollOut: {} m; must be finite", distance);
    while (done < distance) {
      while (knot != knots.end() && knot->distance <= done) {
        ++knot;
      }
      const double next =
          std::min({done + step, distance, knot != knots.end() ? knot->distance : distance});
      // The driven path does not depend on the speed. Choose the speed at which the actuator needs
      // the whole step to reach the new steering angle.
      const double from = schedule.At(done);
      const double to = schedule.At(next);
      const double time = from == to ? next - done : std::abs(to - from) / params.steering_rate;
      state.steering = from;
      state.speed = direction * (next - done) / time;
      KinematicCar car(params, reference, state);
      car.Step({.steering = to, .gear = direction}, time);
      state = car.state();
      done = next;
    }
    states.push_back(state);
    states.back().speed = start.speed;
  }
  return states;
}

}  // namespace trackbed
