#include "trackbed/planning/fillet/steering_room.h"

#include <algorithm>
#include <cmath>

#include "src/planning/fillet/feasible_root.h"

// Equation C.40 permits the fillet radii r at which the function g(r) is negative. As g has a
// single minimum, these radii form an interval between two roots of g. The method TOMS 748 finds
// the roots.

namespace trackbed {
namespace {

/// Relative tolerance of the radius limits, so that a radius exactly on a limit is accepted.
constexpr double kRounding = 1e-12;

}  // namespace

double SteeringRoom(const VehicleParams& vehicle, double speed, double interior_angle,
                    double shorter_leg, double neutral, double radius) {
  const double travel = std::abs(std::atan(vehicle.wheelbase / radius) - neutral);
  return radius / std::tan(interior_angle / 2.0) + speed / vehicle.steering_rate * travel -
         0.5 * shorter_leg;
}

double RoomiestRadius(const VehicleParams& vehicle, double speed, double interior_angle,
                      double neutral, RadiusInterval bounds) {
  const double L = vehicle.wheelbase;
  const double squared = speed / vehicle.steering_rate * L * std::tan(interior_angle / 2.0) - L * L;
  double roomiest = std::sqrt(std::max(0.0, squared));
  if (neutral > 0.0) {
    // For radii above the radius driven at the neutral steering angle d_0, the steering travel from
    // d_0 grows with the radius.
    roomiest = std::min(roomiest, L / std::tan(neutral));
  }
  return std::clamp(roomiest, bounds.low, bounds.high);
}

double LeastSteeringRoom(const VehicleParams& vehicle, double speed, double interior_angle,
                         RadiusInterval bounds) {
  const double radius = RoomiestRadius(vehicle, speed, interior_angle, 0.0, bounds);
  return SteeringRoom(vehicle, speed, interior_angle, 0.0, 0.0, radius);
}

std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds) {
  const double largest = 0.5 * shorter_leg * std::tan(interior_angle / 2.0);
  if (largest < bounds.low * (1.0 - kRounding)) {
    return std::nullopt;
  }
  return RadiusInterval{bounds.low, std::clamp(largest, bounds.low, bounds.high)};
}

std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds, double neutral) {
  const auto g = [&](double r) {
    return SteeringRoom(vehicle, speed, interior_angle, shorter_leg, neutral, r);
  };
  const double lowest = RoomiestRadius(vehicle, speed, interior_angle, neutral, bounds);
  if (g(lowest) > kRounding * shorter_leg) {
    return std::nullopt;
  }
  if (g(lowest) > 0.0) {
    return RadiusInterval{lowest, lowest};
  }
  return RadiusInterval{g(bounds.low) <= 0.0 ? bounds.low : FeasibleRoot(g, bounds.low, lowest),
                        g(bounds.high) <= 0.0 ? bounds.high : FeasibleRoot(g, lowest, bounds.high)};
}

std::optional<double> SteeringRoomSpeed(const VehicleParams& vehicle, double interior_angle,
                                        double shorter_leg, RadiusInterval bounds,
                                        SpeedInterval speeds, double neutral) {
  // The smallest value over all radii r of g(r) (equation C.40) grows with the speed; where it is
  // 0, the speed is the highest permitted one.
  const auto least = [&](double speed) {
    const double r = RoomiestRadius(vehicle, speed, interior_angle, neutral, bounds);
    return SteeringRoom(vehicle, speed, interior_angle, shorter_leg, neutral, r);
  };
  if (least(speeds.high) <= 0.0) {
    return speeds.high;
  }
  if (least(speeds.low) > 0.0) {
    return std::nullopt;
  }
  return FeasibleRoot(least, speeds.low, speeds.high);
}

}  // namespace trackbed
