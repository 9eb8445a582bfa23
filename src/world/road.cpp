#include "trackbed/world/road.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Heights of the ground, with derivatives: a Profile is a height over one coordinate, a Lift is a
/// height over two coordinates.
struct Profile {
  double height = 0.0;
  double slope = 0.0;
};
struct Lift {
  double height = 0.0;
  Vec2 slope = Vec2::Zero();
};

/// Returns the cosine-shaped profile C(distance / reach) and its derivative. The height of this
/// profile is 1 up to distance 0, then decreases smoothly, and is 0 from the distance `reach` on.
Profile Falloff(double distance, double reach) {
  if (distance <= 0.0) {
    return {1.0, 0.0};
  }
  if (distance >= reach) {
    return {0.0, 0.0};
  }
  const double angle = 0.5 * kPi * distance / reach;
  return {std::cos(angle) * std::cos(angle), -0.5 * kPi / reach * std::sin(2.0 * angle)};
}

/// Returns a height profile that is symmetric about 0: flat in the middle, and 0 from the distance
/// `half` on.
Profile SymmetricFalloff(double place, double half, double reach) {
  const Profile one = Falloff(std::abs(place) - half + reach, reach);
  return {one.height, std::copysign(1.0, place) * one.slope};
}

/// Returns the product of a height profile along u and a height profile along v. The slope of the
/// product height is in world axes.
Lift Product(const Pose2& pose, double height, const Profile& along, const Profile& across) {
  const Vec2 u = Direction(pose.yaw);
  return {height * along.height * across.height,
          height * (along.slope * across.height * u + along.height * across.slope * LeftNormal(u))};
}

Lift ComputeLift(const Bump& bump, const Vec2& point_W) {
  const Vec2 p = ToLocal(bump.area.center, point_W);
  const double half_length = 0.5 * bump.area.length;
  const double half_width = 0.5 * bump.area.width;
  return Product(bump.area.center, bump.height, SymmetricFalloff(p.x(), half_length, half_length),
                 SymmetricFalloff(p.y(), half_width, std::min(bump.edge, half_width)));
}

Lift ComputeLift(const Superelevation& stretch, const Vec2& point_W) {
  const Vec2 p = ToLocal(stretch.area.center, point_W);
  const double half_length = 0.5 * stretch.area.length;
  const double width = stretch.area.width;
  // Sign of the lateral coordinate v on the uphill side of the road.
  const double up = std::copysign(1.0, stretch.slope);
  const double w = 0.5 * width + up * p.y();
  Profile across;
  if (w > width) {
    const Profile embankment = Falloff(w - width, width);
    across = {width * embankment.height, up * width * embankment.slope};
  } else if (w > 0.0) {
    across = {w, up};
  }
  return Product(
      stretch.area.center, std::abs(stretch.slope),
      SymmetricFalloff(p.x(), half_length, std::min(stretch.transition_length, half_length)),
      across);
}

/// Among all features of the ground, finds the feature that is highest at the point and returns its
/// height and slope.
Lift Highest(const Ground& ground, const Vec2& point_W) {
  Lift highest;
  const auto look = [&](const auto& features) {
    for (const auto& feature : features) {
      const Lift lift = ComputeLift(feature, point_W);
      if (lift.height > highest.height) {
        highest = lift;
      }
    }
  };
  look(ground.bumps);
  look(ground.side_slopes);
  return highest;
}

}  // namespace

bool IsFlat(const Ground& ground) {
  return ground.grade.isZero(0.0) && IsPlane(ground);
}

bool IsPlane(const Ground& ground) {
  return ground.bumps.empty() && ground.side_slopes.empty() && !ground.terrain;
}

double Rise(const Bump& bump, const Vec2& point_W) {
  return ComputeLift(bump, point_W).height;
}

double Rise(const Superelevation& side_slope, const Vec2& point_W) {
  return ComputeLift(side_slope, point_W).height;
}

OrientedBox Extent(const Bump& bump) {
  return bump.area;
}

OrientedBox Extent(const Superelevation& side_slope) {
  const OrientedBox& area = side_slope.area;
  const Vec2 middle =
      ToWorld(area.center, {0.0, std::copysign(0.5 * area.width, side_slope.slope)});
  return {{middle.x(), middle.y(), area.center.yaw}, area.length, 2.0 * area.width};
}

double GroundHeight(const Ground& ground, const Vec2& point_W) {
  if (ground.terrain) {
    return ground.terrain->At(point_W).height;
  }
  return ground.grade.dot(point_W) + Highest(ground, point_W).height;
}

Vec2 GroundSlope(const Ground& ground, const Vec2& point_W) {
  TRACKBED_REQUIRE(point_W.allFinite(), "GroundSlope: the point {}, {} is not finite", point_W.x(),
                   point_W.y());
  if (ground.terrain) {
    return ground.terrain->At(point_W).slope;
  }
  return ground.grade + Highest(ground, point_W).slope;
}

Eigen::Vector3d GroundNormal(const Ground& ground, const Vec2& point_W) {
  const Vec2 slope = GroundSlope(ground, point_W);
  return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

}  // namespace trackbed
