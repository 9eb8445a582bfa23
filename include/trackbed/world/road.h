#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/world/terrain.h"

/// The road: friction and height. In the frame of a feature, the pose of its area, u runs along its
/// length L and v to the left along its width W, both from the middle. Smooth transitions use C(q)
/// = cos^2(pi/2 q), 1 at q = 0 and 0 for q >= 1.
namespace trackbed {

/// An area of different friction: ice, a wet lane, one side of a split-mu road.
struct FrictionPatch {
  OrientedBox area;
  double friction = 1.0;  ///< factor on the tyres' friction coefficient, > 0
};

/// A bump across the road. Its height above the plane is
///   height C(2 |u| / L) C((|v| - W/2 + e) / e)     with e = min(edge, W/2).
struct Bump {
  OrientedBox area;     ///< its length is along the road
  double height = 0.1;  ///< of its top [m], > 0
  double edge = 0.5;    ///< width of the ramp at each side [m], > 0
};

/// A superelevated (banked) section: it rises from its lower edge, on the plane, to the other edge,
/// beyond which an embankment of the same width descends. With w = W/2 + v for a section that rises
/// to the left, W/2 - v for one that rises to the right, and l the transition length, its height
/// above the plane is
///   |slope| C((|u| - L/2 + r) / r) w               for 0 <= w <= W,     r = min(l, L/2),
///   |slope| C((|u| - L/2 + r) / r) W C((w - W)/W)  beyond.
struct Superelevation {
  OrientedBox area;                 ///< of the section, without the embankment
  double slope = 0.0;               ///< slope toward the left; negative: toward the right
  double transition_length = 10.0;  ///< transition length at both ends [m], > 0
};

/// A plane through the origin with features on it, of which the highest applies where they overlap;
/// or a terrain instead.
struct Ground {
  Vec2 grade = Vec2::Zero();  ///< of the plane: dz/dx and dz/dy
  std::vector<Bump> bumps{};
  std::vector<Superelevation> side_slopes{};
  /// Replaces the plane and its features; null: none. Shared by copies of a world.
  std::shared_ptr<const Terrain> terrain{};
};

/// Whether the ground is the plane z = 0.
bool IsFlat(const Ground& ground);

/// Whether the ground is a plane, level or sloped.
bool IsPlane(const Ground& ground);

/// Height above the plane at a point of the world [m]; 0 outside of the feature.
double Rise(const Bump& bump, const Vec2& point_W);
double Rise(const Superelevation& side_slope, const Vec2& point_W);

/// The bounding rectangle of a feature; for a superelevated section, including its embankment.
OrientedBox Extent(const Bump& bump);
OrientedBox Extent(const Superelevation& side_slope);

/// z of the ground [m]. Continuous. Cost O(features).
double GroundHeight(const Ground& ground, const Vec2& point_W);

/// dz/dx and dz/dy of the ground. At an edge (the long sides of a superelevated section, or where
/// two features meet), the slope of one of its sides. PreconditionError for a point that is not
/// finite.
Vec2 GroundSlope(const Ground& ground, const Vec2& point_W);

/// The upward unit normal.
Eigen::Vector3d GroundNormal(const Ground& ground, const Vec2& point_W);

}  // namespace trackbed
