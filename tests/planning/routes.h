#pragma once

#include <vector>

#include "tests/geometry/random.h"
#include "trackbed/core/angle.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

inline double Radians(double degrees) {
  return degrees * kPi / 180.0;
}
inline double Degrees(double radians) {
  return radians * 180.0 / kPi;
}

/// Returns half a unit in the last of `decimals` printed digits, which is the accuracy of a printed
/// number. The factor 1 + 1e-6 covers our own rounding of a value that is exactly between two
/// printed numbers.
inline double Printed(int decimals) {
  double half = 0.5;
  for (int i = 0; i < decimals; ++i) {
    half /= 10.0;
  }
  return half * (1.0 + 1e-6);
}

/// Return the two routes of the global planner's tests.
inline std::vector<Vec2> RouteA() {
  return {{0, 0}, {40, 0}, {40, 40}, {80, 40}, {80, 80}};
}
inline std::vector<Vec2> RouteB() {
  return {{0, 0}, {30, 0}, {60, 20}, {60, 60}, {100, 80}};
}

/// Returns `count` waypoints from a random start. The legs are `shortest` to `longest` [m] long,
/// and the heading changes by at most `sharpest` [rad] between two legs.
inline std::vector<Vec2> RandomRoute(Random& random, int count, double shortest, double longest,
                                     double sharpest) {
  std::vector<Vec2> route{{random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0)}};
  double yaw = random.Uniform(-kPi, kPi);
  for (int i = 1; i < count; ++i) {
    route.push_back(route.back() + random.Uniform(shortest, longest) * Direction(yaw));
    yaw += random.Uniform(-sharpest, sharpest);
  }
  return route;
}

}  // namespace trackbed
