#include "src/control/timely_steering.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "src/control/preview_distance.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

constexpr int kSteps = 40;  ///< Number of time steps in which the wheels turn from 0 to the limit.
constexpr int kSwings = 4;  ///< Longest predicted drive, in multiples of kSteps time steps.
constexpr int kBits = 40;   ///< Relative precision of the solution: 2^-40.
constexpr double kGentle = 1e-6;  ///< Curvature at which the tyres respond linearly [1/m].

double StepTime(const VehicleParams& vehicle) {
  return vehicle.steering_limit / (kSteps * vehicle.steering_rate);
}

}  // namespace

double TimelySteering::Horizon(const ControlInput& input) {
  return kSwings * kSteps * StepTime(input.vehicle) * std::abs(input.state.speed) +
         ResponseDistance(input);
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
  moments_.reserve(kSwings * kSteps);
  const double end = input.reference.path.length();
  const int direction = input.reference.path.BendAt(input.station).direction;
  double station = input.station + ResponseDistance(input);
  PathPoint point = path.At(station);
  for (int i = 0; i < kSwings * kSteps && station < end && point.direction == direction; ++i) {
    const double way = path.SpeedAt(station) * step_;
    const double speed = direction * path.SpeedAt(station);
    const PathPoint next = path.At(station + way);
    const bool turns = way > 0.0 && next.direction == direction;
    const double curvature =
        turns ? AngleDifference(next.pose.yaw, point.pose.yaw) / (direction * way)
              : point.curvature;
    moments_.push_back({.tangent = tangent(curvature, speed),
                        .speed = speed,
                        .length = tangent(kGentle, speed) / kGentle});
    // Stop the prediction when wheels that start at the angle `most` reach the steering angle of
    // the path.
    const double first = most - std::atan(moments_.front().tangent);
    const double wheels = most - std::copysign(rate_ * step_ * (i + 1), first);
    if ((wheels - std::atan(moments_.back().tangent)) * first <= 0.0) {
      return;
    }
    station += way;
    point = next;
  }
}

GainedErrors TimelySteering::GainedFrom(double steering) const {
  if (moments_.empty()) {
    return {};
  }
  const double side = std::tan(steering) > moments_.front().tangent ? 1.0 : -1.0;
  GainedErrors gained;
  double wheels = steering;
  for (const Moment& moment : moments_) {
    const auto ahead = [&](double angle) {
      return side * (std::tan(angle) - moment.tangent) / moment.length;
    };
    const double begin = ahead(wheels);
    wheels -= side * rate_ * step_;
    const double end = ahead(wheels);
    if (begin <= 0.0) {
      break;
    }
    // Fraction of the time step after which the wheels reach the steering angle of the path.
    const double share = end > 0.0 ? 1.0 : begin / (begin - end);
    const double way = moment.speed * share * step_;
    const double before = gained.heading;
    gained.heading += side * 0.5 * (begin + std::max(end, 0.0)) * way;
    gained.cross_track += 0.5 * (before + gained.heading) * way;
    if (end <= 0.0) {
      break;
    }
  }
  return gained;
}

double TimelySteering::Steer(const ControlInput& input, const RampedPath& path, bool slip,
                             double untimely,
                             const std::function<double(const GainedErrors&)>& law) {
  Follow(input, path, slip, untimely);
  if (moments_.empty()) {
    return untimely;  // the path ends at the car's station
  }
  const double planned = std::atan(moments_.front().tangent);
  const auto excess = [&](double steering) { return law(GainedFrom(steering)) - steering; };
  const double at_planned = untimely - planned;
  const double at_untimely = excess(untimely);
  if (at_planned * at_untimely >= 0.0) {
    return untimely;  // the gained errors would not reduce the steering angle
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
