#pragma once

#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/vehicle/params.h"

/// Polylines that a car can drive: every corner becomes clothoid, arc, clothoid.
///
/// Symbols, for a corner that turns by h [rad] and is taken at v [m/s]: sigma = omega_delta/(L v)
/// sharpness dkappa/ds [1/m^2], at which the wheels turn no faster than they can; kappa peak
/// curvature [1/m]; T tangent length, from the corner to either end of its curve [m].
namespace trackbed {

/// What becomes of a polyline's corners.
enum class Corners {
  kRound,   ///< rounded so that the car can drive them at the planned speed, or at a lower one
  kRefuse,  ///< no plan: no car drives a corner
};

struct CornerLimits {
  double speed = 3.0;          ///< v, at most [m/s]
  double min_speed = 0.5;      ///< no corner is taken more slowly [m/s]
  double max_curvature = 0.2;  ///< [1/m]
  /// Of a car that rolls at the first point: what it needs to slow down for the first corner stays
  /// straight. 0: it stands there [m/s].
  double start_speed = 0.0;
  double deceleration = 1.0;  ///< with which it does [m/s^2], > 0
};

/// A rounded corner.
struct RoundCorner {
  Vec2 at{0.0, 0.0};            ///< the polyline's
  double heading_change = 0.0;  ///< h, signed
  double speed = 0.0;           ///< v
  double sharpness = 0.0;       ///< sigma
  double curvature = 0.0;       ///< kappa, not signed
  double tangent_length = 0.0;  ///< T
  double from = 0.0;            ///< station of its beginning [m]
  double to = 0.0;              ///< and of its end [m]
};
void Visit(DiagnosticsVisitor& out, const RoundCorner& corner);

struct RoundedCorners {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< for people; empty when ok
  Path path;
  std::vector<RoundCorner> corners;
  std::vector<SpeedCap> caps;  ///< of the corners that are slower than the limit
};

/// The curve of a corner of heading change |h| in (0, pi) at v: with a peak of sqrt(|h| sigma), or
/// at the limit with an arc between the clothoids. Its tangent length grows with v.
RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature);

/// Rounds a polyline of at least two points, none the same as the one before. A corner may use half
/// of each of its legs, at the ends of the polyline all of it, but for what a rolling car needs to
/// slow down for it. It is taken as fast as that allows;
/// one at which the footprint is too near to a box, more slowly, which leads nearer to the corner.
/// Guarantees when ok: the path starts at the first point along the first leg and ends at the last,
/// continuous in curvature; no curvature above the limit; the steering rate kept at the caps; the
/// footprint free (CollisionChecker). Else the reason names the corner.
RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear);

/// Leaves out the points at which it goes straight on.
std::vector<Vec2> WithoutStraightOn(const std::vector<Vec2>& polyline);

/// Leaves out what can be from the front on: what is straight on, and what lies between two points
/// whose straight line stays further than `inflation` [m] from every box.
std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           double inflation);

}  // namespace trackbed
