#pragma once

#include <string>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/vehicle/params.h"

/// Makes polylines drivable: replaces every corner by a clothoid, an arc and a second clothoid.
///
/// Symbols, for a corner that the car drives at the speed v [m/s]: h heading change [rad]; kappa
/// peak curvature [1/m]; sigma = omega_delta/(L v) sharpness dkappa/ds [1/m^2], with which the
/// wheels turn at most at their largest rate omega_delta; T tangent length [m], the distance from
/// the corner to either end of its curve.
namespace trackbed {

/// How to treat the corners of a polyline.
enum class Corners {
  /// Corners are rounded so that the car can drive them, if necessary below the planned speed.
  kRound,
  kRefuse,  ///< The planner rejects paths with corners.
};

struct CornerLimits {
  double speed = 3.0;          ///< Upper limit of the speed v [m/s].
  double min_speed = 0.5;      ///< Lower limit of the speed v [m/s].
  double max_curvature = 0.2;  ///< Upper limit of the curvature [1/m].
  /// Speed of the car at the first point [m/s]; 0: at rest. The path is straight while the car
  /// brakes for the first corner.
  double start_speed = 0.0;
  double deceleration = 1.0;  ///< Deceleration before the first corner [m/s^2], > 0.
};

/// A rounded corner.
struct RoundCorner {
  Vec2 at{0.0, 0.0};            ///< Corner of the polyline.
  double heading_change = 0.0;  ///< Heading change h [rad], positive to the left.
  double speed = 0.0;           ///< Speed v in the corner [m/s].
  double sharpness = 0.0;       ///< Sharpness sigma of the clothoids [1/m^2], unsigned.
  double curvature = 0.0;       ///< Peak curvature kappa [1/m], unsigned.
  double tangent_length = 0.0;  ///< Tangent length T [m].
  double from = 0.0;            ///< Station of the curve's start [m].
  double to = 0.0;              ///< Station of the curve's end [m].
};
void Visit(DiagnosticsVisitor& out, const RoundCorner& corner);

struct RoundedCorners {
  PlanStatus status = PlanStatus::kOk;
  std::string reason;  ///< Reason of a failure; empty if ok.
  Path path;
  std::vector<RoundCorner> corners;
  /// Speed caps in the corners that the car drives below the speed limit.
  std::vector<SpeedCap> caps;
};

/// Computes the curve that rounds a corner with heading change |h| in (0, pi) at the speed v. The
/// peak curvature of the curve is sqrt(|h| sigma). If sqrt(|h| sigma) exceeds the maximum
/// curvature, the curve has an arc of the maximum curvature between the clothoids. The tangent
/// length grows with v.
RoundCorner CornerAt(const VehicleParams& vehicle, double heading_change, double speed,
                     double max_curvature);

/// Rounds the corners of a polyline of at least two points, of which no two consecutive points are
/// equal. The curve of a corner may cover half of each adjacent leg, and the whole first or last
/// leg of the polyline. On the first leg, the curve begins only after the distance that a rolling
/// car needs to slow down. The car drives each corner as fast as the lengths of the legs allow. If
/// the footprint is too near to a box on the rounded path, the car drives the nearest corner more
/// slowly, so that the path stays closer to the corner. Guarantees for the status kOk: the path
/// starts at the first point along the first leg, and ends at the last point. The curvature is
/// continuous and at most `max_curvature`. At the capped speeds, the steering rate is within the
/// car's limit. The footprint is clear of all boxes (CollisionChecker). For any other status, the
/// reason names the corner or the place of the collision.
RoundedCorners RoundCorners(const VehicleParams& vehicle, const std::vector<Vec2>& polyline,
                            const CornerLimits& limits, const CollisionChecker& clear);

/// Removes points at which the polyline continues straight.
std::vector<Vec2> WithoutCollinearPoints(const std::vector<Vec2>& polyline);

/// Shortens a polyline greedily from its start. Removes points at which the polyline continues
/// straight. Removes the points between two points if the segment that connects the two is more
/// than `inflation` [m] away from every box.
std::vector<Vec2> Shortcut(const std::vector<Vec2>& polyline, const std::vector<OrientedBox>& boxes,
                           double inflation);

}  // namespace trackbed
