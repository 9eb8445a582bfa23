#pragma once

#include <Eigen/Core>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

/// What wheels roll on: how slippery it is, and how high. In a feature's own frame, the pose of its
/// area, u runs along its length L and v to the left along its width W, both from the middle. What
/// comes and goes smoothly does so as C(q) = cos^2(pi/2 q), 1 at q = 0 and 0 from q = 1 on.
namespace trackbed {

/// A stretch where the road is another: ice, a wet lane, one side of a split road.
struct FrictionPatch {
  OrientedBox area;
  double friction = 1.0;  ///< factor on the tyres' own friction coefficient, > 0
};

/// A hump across the way, above the plane by
///   height C(2 |u| / L) C((|v| - W/2 + e) / e)     with e = min(edge, W/2).
struct Bump {
  OrientedBox area;     ///< the length is that of the way over it
  double height = 0.1;  ///< of its top [m], > 0
  double edge = 0.5;    ///< width over which each of its sides comes down [m], > 0
};

/// A stretch that leans, as a banked road does: from its lower edge, which lies on the plane, it
/// rises to the other one, and behind that an embankment of the same width comes down again. With
/// w = W/2 + v for a stretch that rises to the left, W/2 - v for one that rises to the right, it is
/// above the plane by
///   |slope| C((|u| - L/2 + r) / r) w               for 0 <= w <= W,     r = min(run_in, L/2),
///   |slope| C((|u| - L/2 + r) / r) W C((w - W)/W)  beyond.
struct Superelevation {
  OrientedBox area;      ///< of what leans; the embankment lies beside it
  double slope = 0.0;    ///< rise over run to its left; negative: it rises to the right
  double run_in = 10.0;  ///< length over which it comes at either end [m], > 0
};

/// A plane through the origin with solids on it. Where several are, the highest counts.
struct Ground {
  Vec2 grade = Vec2::Zero();  ///< of the plane: dz/dx and dz/dy
  std::vector<Bump> bumps{};
  std::vector<Superelevation> side_slopes{};
};

/// Whether the ground is the plane z = 0.
bool IsFlat(const Ground& ground);

/// Above the plane, at a point of the world [m]; 0 outside.
double Rise(const Bump& bump, const Vec2& point_W);
double Rise(const Superelevation& side_slope, const Vec2& point_W);

/// The rectangle outside which a feature rises nowhere: of a side slope, with its embankment.
OrientedBox Extent(const Bump& bump);
OrientedBox Extent(const Superelevation& side_slope);

/// z of the ground [m]. Continuous. Cost O(features).
double GroundHeight(const Ground& ground, const Vec2& point_W);

/// dz/dx and dz/dy of the ground. Where it has an edge (the long sides of a side slope, or where
/// two features meet), that of one of its sides.
Vec2 GroundSlope(const Ground& ground, const Vec2& point_W);

/// The upward normal, of length 1.
Eigen::Vector3d GroundNormal(const Ground& ground, const Vec2& point_W);

}  // namespace trackbed
