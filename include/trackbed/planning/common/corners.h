#pragma once

#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/vehicle/params.h"

/// Makes polylines drivable: every corner becomes clothoid, arc, clothoid.
///
/// Symbols, for a corner that turns by h [rad] and is taken at v [m/s]: sigma = omega_delta/(L v)
/// sharpness dkappa/ds [1/m^2], at which the wheels turn no faster than they can; kappa peak
/// curvature [1/m]; T tangent length, from the corner to either end of its curve [m].
namespace trackbed {

/// How to treat the corners of a polyline.
enum class Corners {
  kRound,   ///< rounded so that the car can drive them, if necessary below the planned speed
  kRefuse,  ///< no plan: a car cannot drive a corner
};

struct CornerLimits {
  double speed = 3.0;          ///< upper limit of v [m/s]
  double min_speed = 0.5;      ///< lower limit of v [m/s]
  double max_curvature = 0.2;  ///< [1/m]
  /// Speed of the car at the first point [m/s]; 0: at rest. The braking distance to the first
  /// corner stays straight.
  double start_speed = 0.0;
  double deceleration = 1.0;  ///< with which the car slows down for it [m/s^2], > 0
};

/// A rounded corner.
struct RoundCorner {
  Vec2 at{0.0, 0.0};            ///< the polyline's corner
  double heading_change = 0.0;  ///< h, signed
  double speed = 0.0;           ///< v
  double sharpness = 0.0;       ///< sigma
  double curvature = 0.0;       ///< kappa, not signed
  double tangent_length = 0.0;  ///< T
  double from = 0.0;            ///< station of its start [m]
  double to = 0.0;              ///< station of its end [m]
};
void Visit(DiagnosticsVisitor& out, const RoundCorner& corner);

struct RoundedCorners {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< empty when ok
  Path path;
  std::vector<RoundCorner> corners;
  std::vector<SpeedCap> caps;  ///< of the corners taken below the speed limit
};

/// The curve at v of a corner with heading change |h| in (0, pi): a peak curvature of sqrt(|h|
/// sigma), or the maximum curvature with an arc between the clothoids. The tangent length grows
/// with v.
RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature);

/// Rounds a polyline of at least two points, without repeated neighbors. A corner may use half of
/// each of its legs, and the whole leg at the ends of the polyline, minus the distance that a
/// rolling car needs to slow down. Each corner is taken as fast as its legs allow, or more slowly,
/// which brings the path closer to the corner, if the footprint is otherwise too near to a box.
/// Guarantees when ok: the path starts at the first point along the first leg and ends at the last,
/// with continuous curvature; no curvature above the limit; the steering rate within the car's at
/// the caps; the footprint free (CollisionChecker). Otherwise the reason names the corner.
RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear);

/// Removes points at which the polyline continues straight.
std::vector<Vec2> WithoutCollinearPoints(const std::vector<Vec2>& polyline);

/// Shortens a polyline greedily from its start: removes points at which it continues straight, and
/// points between two others whose connecting segment stays further than `inflation` [m] from every
/// box.
std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           double inflation);

}  // namespace trackbed
