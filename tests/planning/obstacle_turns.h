#pragma once

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"

/// Obstacles in a turn of the reference car's plan, for the tests of the local planners.
namespace trackbed {

inline constexpr double kSpeed = 3.0;     // [m/s]
inline constexpr double kDistance = 1.5;  // Safe distance SD [m].
inline const SpeedLimits kLimits{kSpeed, 1.0, 1.0};

/// Returns the clearance between two boxes, computed by Boost.Geometry independently of the
/// planner's code.
inline double ByBoost(const OrientedBox& a, const OrientedBox& b) {
  using Point = boost::geometry::model::d2::point_xy<double>;
  using Polygon = boost::geometry::model::polygon<Point, false, true>;
  const auto polygon_of = [](const OrientedBox& box) {
    Polygon polygon;
    for (const Vec2& corner : box.Corners()) {
      polygon.outer().emplace_back(corner.x(), corner.y());
    }
    polygon.outer().push_back(polygon.outer().front());
    return polygon;
  };
  return boost::geometry::distance(polygon_of(a), polygon_of(b));
}

/// Returns the footprint of a car whose rear axle is at the station `s` of the path, computed from
/// the dimensions of the car.
inline OrientedBox FootprintOn(const Path& path, double s, const VehicleParams& car) {
  const Pose2 rear = path.At(s).pose;
  const double ahead = 0.5 * car.length - car.rear_overhang;
  return {{rear.x + ahead * std::cos(rear.yaw), rear.y + ahead * std::sin(rear.yaw), rear.yaw},
          car.length,
          car.width};
}

inline double PathClearance(const Path& path, const std::vector<OrientedBox>& obstacles,
                            const VehicleParams& car, Stations within) {
  double clearance = std::numeric_limits<double>::infinity();
  for (double s = std::max(within.from, 0.0); s <= std::min(within.to, path.length()); s += 0.02) {
    for (const OrientedBox& obstacle : obstacles) {
      clearance = std::min(clearance, ByBoost(FootprintOn(path, s, car), obstacle));
    }
  }
  return clearance;
}

/// Largest error of a sampled clearance [m]. The planner samples the footprint every 0.05 m, so a
/// minimum of the distance is at most 0.025 m from a sample. Near a minimum, the distance is
/// quadratic in the station. At full lock (turning radius 5.1 m), a corner 3.7 m from the rear axle
/// comes closer by at most 0.025^2 x (1/5.1 + 1/3.7)/2 = 1.5e-4 m.
inline constexpr double kBetweenSamples = 2e-4;  // [m]
/// Tolerance of the clearance [m]. The planner accepts its own curves if they miss the safe
/// distance by up to 0.5 mm.
inline constexpr double kClearanceTolerance = 5e-4 + kBetweenSamples;

/// A route with one turn of the radius `radius` [m] between two straights.
struct Course {
  double radius = 20.0;
  double before = 42.7;  ///< Length of the straight from the start to the arc [m].
  double turn = 0.5 * kPi;
  double after = 42.7;

  [[nodiscard]] std::vector<Vec2> Waypoints() const {
    const double tangent = radius * std::tan(0.5 * std::abs(turn));
    const Vec2 corner{before + tangent, 0.0};
    return {{0.0, 0.0}, corner, corner + (after + tangent) * Direction(turn)};
  }

  [[nodiscard]] Plan Global() const {
    FilletOptions options;
    options.radius = radius;
    options.constraint = RadiusConstraint::kNone;
    return MakePlan({.vehicle = ReferenceCar(),
                     .waypoints = Waypoints(),
                     .start_speed = kSpeed,
                     .speed = kLimits,
                     .seed = 0},
                    options);
  }

  /// Returns the pose on the arc at the fraction `share` of its length.
  [[nodiscard]] Pose2 OnArc(double share) const {
    return Global().reference.path.At(before + share * radius * std::abs(turn)).pose;
  }
};

inline Plan Around(const Plan& plan, const std::vector<OrientedBox>& obstacles,
                   const AvoiderOptions& options = {}) {
  return PlanAround({.vehicle = ReferenceCar(),
                     .plan = plan,
                     .speed = kLimits,
                     .obstacles = obstacles,
                     .station = 0.0,
                     .station_speed = kSpeed,
                     .car = {},
                     .seed = 1},
                    options);
}

}  // namespace trackbed
