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
  /// Rounded so that the car can drive them, if necessary below the planned speed.
  kRound,
  kRefuse,  ///< Rejected: the planner returns no plan.
};

struct CornerLimits {
  double speed = 3.0;          ///< Upper limit of v [m/s].
  double min_speed = 0.5;      ///< Lower limit of v [m/s].
  double max_curvature = 0.2;  ///< Upper limit of the curvature [1/m].
  /// Speed of the car at the first point [m/s]; 0: at rest. The braking distance to the first
  /// corner stays straight.
  double start_speed = 0.0;
  double deceleration = 1.0;  ///< Deceleration before the first corner [m/s^2], > 0.
};

/// A rounded corner.
struct RoundCorner {
  Vec2 at{0.0, 0.0};            ///< Corner of the polyline.
  double heading_change = 0.0;  ///< Heading change h, signed.
  double speed = 0.0;           ///< Speed v.
  double sharpness = 0.0;       ///< Sharpness sigma.
  double curvature = 0.0;       ///< Curvature kappa, unsigned.
  double tangent_length = 0.0;  ///< Tangent length T.
  double from = 0.0;            ///< Station of the curve's start [m].
  double to = 0.0;              ///< Station of the curve's end [m].
};
void Visit(DiagnosticsVisitor& out, const RoundCorner& corner);

struct RoundedCorners {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason of a failure; empty if ok.
  Path path;
  std::vector<RoundCorner> corners;
  std::vector<SpeedCap> caps;  ///< Caps of the corners that are driven below the speed limit.
};

/// The curve at speed v for a corner with heading change |h| in (0, pi). The peak curvature of the
/// curve is sqrt(|h| sigma), or the maximum curvature with an arc between the clothoids. The
/// tangent length grows with v.
RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature);

/// Rounds a polyline of at least two points, without repeated neighbors. A corner may use half of
/// each of its legs, and the whole leg at the ends of the polyline, minus the distance that a
/// rolling car needs to slow down. Each corner is driven as fast as its legs allow. If the
/// footprint is then too near to a box, the corner is driven more slowly, which brings the path
/// closer to the corner. Guarantees if ok: the path starts at the first point along the first leg
/// and ends at the last point. The curvature is continuous and within the limit, and the steering
/// rate at the caps is within the car's. The footprint is free (CollisionChecker). If not ok, the
/// reason names the corner.
RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear);

/// Removes points at which the polyline continues straight.
std::vector<Vec2> WithoutCollinearPoints(const std::vector<Vec2>& polyline);

/// Shortens a polyline greedily from its start. Removes points at which the polyline continues
/// straight. Removes points between two others if the segment that connects these is more than
/// `inflation` [m] away from every box.
std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           double inflation);

}  // namespace trackbed
