#include "src/control/timely_steering.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace trackbed {
namespace {

constexpr int kSteps = 40;  ///< Number of time steps in which the wheels turn from 0 to the limit.
constexpr int kSwings = 4;  ///< Multiple of this time that is followed.
constexpr int kBits = 40;   ///< Relative precision of the solution: 2^-40.
constexpr double kGentle = 1e-6;  ///< Curvature of a steady turn with a linear response [1/m].

double StepTime(const VehicleParams& vehicle) {
  return vehicle.steering_limit / (kSteps * vehicle.steering_rate);
}

}  // namespace

double TimelySteering::Horizon(const ControlInput& input) {
  return kSwings * kSteps * StepTime(input.vehicle) * std::abs(input.state.speed);
}

void TimelySteering::Follow(const ControlInput& input, const RampedPath& path, bool slip,
                            double most) {
  const VehicleParams& car = input.vehicle;
  const auto tangent = [&](double curvature, double speed) {
    const SteadyTurn turn =
        slip ? SteadyTurnOn(car, curvature, speed) : TurnWithoutSlip(car, curvature, speed);
    return std::tan(std::clamp(turn.steering, -car.steering_limit, car.steering_limit));
  };
  step_ = StepTime(car);
  rate_ = car.steering_rate;
  moments_.clear();
  moments_.reserve(kSwings * kSteps + 1);
  const double end = input.reference.path.length();
  const int direction = input.reference.path.BendAt(input.station).direction;
  double station = input.station;
  double left = 0.0;
  for (int i = 0; i <= kSwings * kSteps; ++i) {
    const double speed = direction * path.SpeedAt(station);
    const PathPoint point = path.At(station);
    const bool leaves = station >= end || point.direction != direction;
    moments_.push_back({.tangent = tangent(point.curvature, speed),
                        .speed = speed,
                        .length = tangent(kGentle, speed) / kGentle,
                        .leaves = leaves});
    // Wheels that begin at `most` have met the path's steering.
    const double met = std::atan(moments_.back().tangent);
    const double turned = rate_ * step_ * i;
    left = i == 0 ? most - met : left;
    const double wheels = most - std::copysign(turned, left);
    if (leaves || (wheels - met) * left <= 0.0) {
      return;
    }
    station += std::abs(speed) * step_;
  }
}

GainedErrors TimelySteering::GainedFrom(double steering) const {
  const double side = std::tan(steering) > moments_.front().tangent ? 1.0 : -1.0;
  const auto ahead = [&](const Moment& moment, double wheels) {
    return side * (std::tan(wheels) - moment.tangent) / moment.length;
  };
  GainedErrors gained;
  double wheels = steering;
  double now = ahead(moments_.front(), wheels);
  for (std::size_t i = 0; i + 1 < moments_.size() && now > 0.0 && !moments_[i].leaves; ++i) {
    wheels -= side * rate_ * step_;
    const double next = ahead(moments_[i + 1], wheels);
    // Fraction of the step after which the wheels have met the path's steering.
    const double share = next > 0.0 ? 1.0 : now / (now - next);
    const double way = moments_[i].speed * share * step_;
    const double before = gained.heading;
    gained.heading += side * 0.5 * (now + std::max(next, 0.0)) * way;
    gained.cross_track += 0.5 * (before + gained.heading) * way;
    now = next;
  }
  return gained;
}

double TimelySteering::Steer(const ControlInput& input, const RampedPath& path, bool slip,
                             const std::function<double(const GainedErrors&)>& law) {
  const double untimely = law({});
  Follow(input, path, slip, untimely);
  const double planned = std::atan(moments_.front().tangent);
  const auto excess = [&](double steering) { return law(GainedFrom(steering)) - steering; };
  const double at_planned = untimely - planned;
  const double at_untimely = excess(untimely);
  if (at_planned * at_untimely >= 0.0) {
    return untimely;  // the wheels return at once
  }
  std::uintmax_t iterations = 30;
  const bool left = at_planned > 0.0;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, left ? planned : untimely, left ? untimely : planned, left ? at_planned : at_untimely,
      left ? at_untimely : at_planned, boost::math::tools::eps_tolerance<double>(kBits),
      iterations);
  return 0.5 * (low + high);
}

}  // namespace trackbed
