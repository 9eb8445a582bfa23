#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/world/terrain.h"

/// The friction coefficient and the height of the road. A bump or a superelevation is a feature of
/// the road, and covers a rectangular area. In the coordinate frame of a feature's area, u counts
/// along the length L and v counts to the left along the width W, both from the middle of the area.
/// Smooth transitions of the road's height use the function C(q) = cos^2(pi/2 q), which is 1 at q =
/// 0; for q >= 1, C is 0.
namespace trackbed {

/// An area of the road with a different friction coefficient, such as ice, a wet lane, or one side
/// of a split-mu road.
struct FrictionPatch {
  OrientedBox area;
  /// Factor by which the tyres' friction coefficient is multiplied in the area, > 0.
  double friction = 1.0;
};

/// A speed bump across the road. With the length L and the width W of its area, the bump rises
/// above the plane by
///   height C(2 |u| / L) C((|v| - W/2 + e) / e)     with e = min(edge, W/2).
struct Bump {
  OrientedBox area;     ///< Area of the bump; the length of the area is along the road.
  double height = 0.1;  ///< Height of the bump's top [m], > 0.
  double edge = 0.5;    ///< Width of the ramp at each side of the bump [m], > 0.
};

/// A superelevated (banked) section of the road. The banked section rises from its lower edge,
/// which lies on the plane, to its upper edge. Beyond the upper edge of the section, an embankment
/// of the same width descends to the plane. Let w be the distance of the lateral coordinate v from
/// the lower edge of a section of the width W: W/2 + v if the section rises to the left, and W/2 -
/// v if the section rises to the right. The length of the transition at each end of the section is
/// l. With the length L and the width W of its area, the section rises above the plane by
///   |slope| C((|u| - L/2 + r) / r) w               for 0 <= w <= W,     r = min(l, L/2),
///   |slope| C((|u| - L/2 + r) / r) W C((w - W)/W)  beyond.
struct Superelevation {
  OrientedBox area;    ///< Area of the banked section, without the embankment.
  double slope = 0.0;  ///< Lateral slope, positive if the section rises to the left.
  /// Length of the transition at both ends of the section [m], > 0.
  double transition_length = 10.0;
};

/// The ground: either a plane through the origin with bumps and superelevations, or a terrain.
/// Where bumps and superelevations overlap, the highest surface applies.
struct Ground {
  Vec2 grade = Vec2::Zero();  ///< Slopes dz/dx and dz/dy of the ground's plane.
  std::vector<Bump> bumps{};
  std::vector<Superelevation> side_slopes{};
  /// Terrain that replaces the plane with its bumps and superelevations; null: no terrain. Copies
  /// of a world share its terrain.
  std::shared_ptr<const Terrain> terrain{};
};

/// Whether the ground is the plane z = 0.
bool IsFlat(const Ground& ground);

/// Whether the ground is a plane, level or sloped.
bool IsPlane(const Ground& ground);

/// Returns the height of a bump or superelevation above the plane at a point of the world [m]; 0
/// outside of its area.
double Rise(const Bump& bump, const Vec2& point_W);
double Rise(const Superelevation& side_slope, const Vec2& point_W);

/// Returns the bounding rectangle of a bump or superelevation, including the embankment.
OrientedBox Extent(const Bump& bump);
OrientedBox Extent(const Superelevation& side_slope);

/// Returns the height z of the ground at a point [m]. The ground's height is continuous. The run
/// time of GroundHeight is proportional to the number of bumps and superelevations.
double GroundHeight(const Ground& ground, const Vec2& point_W);

/// Returns the slopes dz/dx and dz/dy of the ground. Where the slope jumps (at the long sides of a
/// superelevation, and where bumps and superelevations meet), returns the slope of one of the two
/// sides. Throws PreconditionError if the point is not finite.
Vec2 GroundSlope(const Ground& ground, const Vec2& point_W);

/// Returns the unit vector that points upward, normal to the ground.
Eigen::Vector3d GroundNormal(const Ground& ground, const Vec2& point_W);

}  // namespace trackbed
