#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/frenet/frenet.h"
#include "trackbed/planning/frenet/lattice.h"
#include "trackbed/planning/replan/replan_options.h"

/// Plans the next motion along a route, in the route's Frenet frame. The motion passes obstacles in
/// the way if possible; otherwise, it stays behind the obstacles.
///
/// Symbols: as in planning/frenet/frenet.h; V desired speed [m/s].
namespace trackbed {

/// Speed below which an obstacle is treated as standing, so that the car passes it instead of
/// following it [m/s].
inline constexpr double kStandstillSpeed = 0.3;

struct AlongEntry {
  const char* name;
  const char* summary;
  AlongOptions defaults;
};

/// Returns all methods that find motions along a route.
const std::vector<AlongEntry>& AlongMethods();

/// A route, prepared for planning motions along it. The curvature of the route changes no faster
/// than the wheels can turn at the planned speeds (path/smooth_curvature.h). Beyond its end, the
/// route continues straight for `beyond` [m], so that motions may end beyond the route. On a track,
/// the route is unchanged, because its curvature is already continuous; motions stay within the
/// track's edges.
struct RouteFrame {
  Path path;
  double goal = 0.0;  ///< Station of the route's end [m].
  /// Edges of the track relative to the path; null if the route is not on a track.
  std::shared_ptr<const RoadEdges> edges{};
};

/// Makes the frame of a route. Motions keep the distance `edge_distance` [m] from a track's edges.
/// Where a car on the route is closer to an edge, motions keep the distance of that car
/// (EdgesBeside). Cost: 10 us per meter, on a track 50 us. Throws InternalError for a route with
/// cusps.
RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance = 0.0);

struct AlongRequest {
  VehicleParams vehicle;
  SpeedLimits speed;    ///< Upper limits on speed and accelerations.
  double wanted = 0.0;  ///< Desired speed V [m/s], at most the speed of the limits.
  FrenetState start;    ///< State of the car in the Frenet frame of the route.
  std::vector<MovingBox> obstacles;
};

enum class ManeuverType {
  kNone,  ///< No motion was found.
  /// Continue along the route, past obstacles in the way, or to the end of the route.
  kProceed,
  kFollow,  ///< Follow a moving obstacle.
  /// Continue, but not past a standing obstacle. The next motion may be kStop.
  kApproach,
  kStop,  ///< Stop behind a standing obstacle.
};

/// Returns the name of a type: "none", "on", "follow", "approach", "stop".
const char* ToString(ManeuverType kind);

struct AlongPlan {
  ManeuverType kind = ManeuverType::kNone;
  FrenetPlan found;  ///< Result of the method that searched for the motion.
  /// Points of the motion, and of braking to a standstill after the motion. The car brakes at the
  /// last offset of the motion or, on a track, back on the route. The car therefore never depends
  /// on finding another motion. The list is empty if no motion was found.
  std::vector<TrajectoryPoint> points;
  bool to_goal = false;  ///< Whether the motion ends at the end of the route.

  [[nodiscard]] bool ok() const { return kind != ManeuverType::kNone; }
};
void Visit(DiagnosticsVisitor& out, const AlongPlan& along);

/// The nearest obstacle in the car's way along the path. An obstacle is in the way if its
/// footprint, in path coordinates, comes closer than the safe distance to the strip that the car
/// covers on the path.
struct Leader {
  std::size_t obstacle = 0;  ///< Index of the obstacle in the request.
  double rear = 0.0;         ///< Present station of the obstacle's nearest point [m].
  double speed = 0.0;        ///< Speed of the obstacle along the path [m/s].
  double left = 0.0;         ///< Left end of the obstacle's range of offsets [m].
  double right = 0.0;
};

/// Finds the nearest obstacle in the car's way up to the station `to`; nullopt if the way is clear.
std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to);

/// Tries motions in this order: stop at the end of the route, if the end is near; continue at V,
/// past obstacles in the way; follow a moving leader; continue more slowly, if that passes the
/// obstacle; stop behind a standing leader; continue for now, as fast as the free space allows. The
/// cost may prefer a lower speed to an offset. Passing at V is nevertheless tried before slowing
/// down, because slowing down does not remove a standing obstacle.
///
/// Guarantees: the motion has the guarantees of PlanFrenet or PlanLattice. The braking after the
/// motion meets the limits and the safe distance, checked every 0.1 s. On a track, the car also
/// stays within the edges while it brakes: at the last offset of the motion, or back on the route
/// if that offset leads off the track. The motion ends at most 0.05 m beyond the goal. The motion
/// ends beside the route only if two opposite turns of the smallest radius can return to the route
/// before the goal. The same input gives the same bytes. Route and frame are not changed. Errors:
/// those of PlanFrenet or PlanLattice; InternalError if there are no speed factors, or if the
/// desired speed or a gap is out of range. Cost: a few times the cost of PlanFrenet or PlanLattice.
AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options);

}  // namespace trackbed
