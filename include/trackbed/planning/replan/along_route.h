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

/// The next motion along a route, in the route's Frenet frame: past obstacles in the way if
/// possible, otherwise behind the obstacles.
///
/// Symbols: those of planning/frenet.h; V desired speed [m/s].
namespace trackbed {

/// Speed below which an obstacle is treated as standing, so that the car passes it instead of
/// following it [m/s].
inline constexpr double kStandstillSpeed = 0.3;

struct AlongEntry {
  const char* name;
  const char* summary;
  AlongOptions defaults;
};

/// All methods that find motions along a route.
const std::vector<AlongEntry>& AlongMethods();

/// The route in the form that motions need. The curvature of the route changes no faster than the
/// wheels can turn at the planned speeds (path/smooth_curvature.h). Beyond its end, the route
/// continues straight for `beyond` [m], as far as motions may reach. On a track, the route is
/// unchanged, because its curvature is already continuous; motions stay within the track's edges.
struct RouteFrame {
  Path path;
  double goal = 0.0;  ///< Station of the route's end [m].
  /// Edges of the track relative to the path; null if the route is not on a track.
  std::shared_ptr<const RoadEdges> edges{};
};

/// Makes the frame of a route. Motions keep `edge_distance` [m] from a track's edges, or the
/// distance of the route if that is smaller (EdgesBeside). Cost: 10 us per meter, on a track 50 us.
/// InternalError for a route with cusps.
RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance = 0.0);

struct AlongRequest {
  VehicleParams vehicle;
  SpeedLimits speed;    ///< Upper limits on speed and accelerations.
  double wanted = 0.0;  ///< Desired speed V, at most the limits' speed.
  FrenetState start;    ///< State of the car relative to the frame.
  std::vector<MovingBox> obstacles;
};

enum class ManeuverType {
  kNone,  ///< No motion was found.
  /// Continue along the route, past obstacles in the way, or to its end.
  kProceed,
  kFollow,  ///< Follow a moving obstacle.
  /// Continue, but not past a standing obstacle. The next motion may be kStop.
  kApproach,
  kStop,  ///< Stop behind a standing obstacle.
};

/// The name of a type: "none", "on", "follow", "approach", "stop".
const char* ToString(ManeuverType kind);

struct AlongPlan {
  ManeuverType kind = ManeuverType::kNone;
  FrenetPlan found;  ///< Result of the method.
  /// The motion, followed by braking to a standstill at its last offset or, on a track, back on the
  /// route. The car therefore never depends on finding another motion. Empty if no motion was
  /// found.
  std::vector<TrajectoryPoint> points;
  bool to_goal = false;  ///< Whether the motion ends at the end of the route.

  [[nodiscard]] bool ok() const { return kind != ManeuverType::kNone; }
};
void Visit(DiagnosticsVisitor& out, const AlongPlan& along);

/// The nearest obstacle in the car's way along the path. The footprint of such an obstacle, in path
/// coordinates, comes closer to the car's lane on the path than the safe distance.
struct Leader {
  std::size_t obstacle = 0;  ///< Index of the obstacle in the request.
  double rear = 0.0;         ///< Present station of the obstacle's nearest point [m].
  double speed = 0.0;        ///< Speed of the obstacle along the path [m/s].
  double left = 0.0;         ///< Left end of the obstacle's range of offsets [m].
  double right = 0.0;
};

/// Finds the leader up to the station `to`; nullopt if the way is clear.
std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to);

/// Tries motions in this order: stop at the end of the route, if that is near; continue at V, past
/// obstacles in the way; follow a moving leader; continue more slowly, if that passes the obstacle;
/// stop behind a standing leader; continue for now, as fast as the free space allows. The cost may
/// prefer a lower speed to an offset. Passing at V is nevertheless tried before slowing down,
/// because slowing down does not remove a standing obstacle.
///
/// Guarantees: those of PlanFrenet or PlanLattice for the motion. The braking after it meets the
/// limits and the safe distance, checked every 0.1 s. On a track, the braking also stays within the
/// edges: at the motion's last offset, or back on the route if that offset leads off the track. The
/// motion ends at most 0.05 m beyond the goal, and beside the route only if two opposite turns of
/// the tightest radius can return to the route before the goal. The same input gives the same
/// bytes. Route and frame are not changed. Errors: those of the method; InternalError without speed
/// factors, and for a desired speed or gaps out of range. Cost: a few times that of the method.
AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options);

}  // namespace trackbed
