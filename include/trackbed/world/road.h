#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/world/terrain.h"

/// The road: friction and height. The frame of a feature is the pose of its area. In that frame, u
/// runs along the length L and v to the left along the width W, both from the middle. Smooth
/// transitions use C(q) = cos^2(pi/2 q), 1 at q = 0 and 0 for q >= 1.
namespace trackbed {

/// An area of different friction: ice, a wet lane, one side of a split-mu road.
struct FrictionPatch {
  OrientedBox area;
  double friction = 1.0;  ///< Factor on the tyres' friction coefficient, > 0.
};

/// A bump across the road. The height of a bump above the plane is
///   height C(2 |u| / L) C((|v| - W/2 + e) / e)     with e = min(edge, W/2).
struct Bump {
  OrientedBox area;     ///< Area of the bump, with its length along the road.
  double height = 0.1;  ///< Height of the top [m], > 0.
  double edge = 0.5;    ///< Width of the ramp at each side [m], > 0.
};

/// A superelevated (banked) section. The section rises from the lower edge, which lies on the
/// plane, to the upper edge. Beyond the upper edge, an embankment of the same width descends. Let w
/// be W/2 + v for a section that rises to the left, W/2 - v for a section that rises to the right,
/// and l the transition length. The height above the plane is
///   |slope| C((|u| - L/2 + r) / r) w               for 0 <= w <= W,     r = min(l, L/2),
///   |slope| C((|u| - L/2 + r) / r) W C((w - W)/W)  beyond.
struct Superelevation {
  OrientedBox area;                 ///< Area of the section, without the embankment.
  double slope = 0.0;               ///< Slope, positive if the section rises to the left.
  double transition_length = 10.0;  ///< Transition length at both ends [m], > 0.
};

/// The ground: a plane through the origin with features on it, or a terrain instead. If features
/// overlap, the highest one applies.
struct Ground {
  Vec2 grade = Vec2::Zero();  ///< Slopes dz/dx and dz/dy of the plane.
  std::vector<Bump> bumps{};
  std::vector<Superelevation> side_slopes{};
  /// Terrain that replaces the plane and its features; null: none. Copies of a world share it.
  std::shared_ptr<const Terrain> terrain{};
};

/// Whether the ground is the plane z = 0.
bool IsFlat(const Ground& ground);

/// Whether the ground is a plane, level or sloped.
bool IsPlane(const Ground& ground);

/// Returns the height of a feature above the plane at a point of the world [m]; 0 outside of the
/// feature.
double Rise(const Bump& bump, const Vec2& point_W);
double Rise(const Superelevation& side_slope, const Vec2& point_W);

/// Returns the bounding rectangle of a feature. For a superelevated section, the rectangle includes
/// the embankment.
OrientedBox Extent(const Bump& bump);
OrientedBox Extent(const Superelevation& side_slope);

/// The height z of the ground [m], which is continuous. Cost O(features).
double GroundHeight(const Ground& ground, const Vec2& point_W);

/// The slopes dz/dx and dz/dy of the ground. At the long sides of a superelevated section, and at
/// the border of two features, the result is the slope of one of the two sides. PreconditionError
/// for a point that is not finite.
Vec2 GroundSlope(const Ground& ground, const Vec2& point_W);

/// The upward unit normal of the ground.
Eigen::Vector3d GroundNormal(const Ground& ground, const Vec2& point_W);

}  // namespace trackbed
