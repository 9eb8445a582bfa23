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

/// The next stretch of the way along a route, in its Frenet frame: past what stands in the way if
/// that can be, else behind it.
///
/// Symbols: those of planning/frenet.h; V wanted speed [m/s].
namespace trackbed {

/// Slower than this, an obstacle stands: nobody follows it, ways are looked for round it [m/s].
inline constexpr double kStandsBelow = 0.3;

struct AlongEntry {
  const char* name;
  const char* summary;
  AlongOptions defaults;
};

/// Every way to find motions along a route.
const std::vector<AlongEntry>& AlongMethods();

/// The route as motions take it: with a curvature that changes no faster than the wheels can turn
/// at the speeds it is driven at (path/smooth_curvature.h), and straight on beyond its end as far
/// as motions may reach, `beyond` [m]. On a track the route stays as it is, because its curvature
/// is continuous, and motions keep within the edges.
struct RouteFrame {
  Path path;
  double goal = 0.0;  ///< station of the route's end [m]
  /// Of the track, as seen from the path; none elsewhere.
  std::shared_ptr<const RoadEdges> edges{};
};

/// From a track's edges motions keep `edge_distance` [m], or as much as the route itself keeps
/// where that is less (EdgesBeside). Cost: 10 us a meter, on a track 50 us. InternalError for a
/// route with cusps.
RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance = 0.0);

struct AlongRequest {
  VehicleParams vehicle;
  SpeedLimits speed;    ///< no faster, no harder
  double wanted = 0.0;  ///< V, at most the limits' speed
  FrenetState start;    ///< of the car against the frame
  std::vector<MovingBox> obstacles;
};

enum class ManeuverType {
  kNone,      ///< nothing was found
  kProceed,   ///< on along the route, past what is in the way, or to its end
  kFollow,    ///< behind something that moves
  kApproach,  ///< on, but not past what stands ahead: the next time it may be kStop
  kStop,      ///< to rest behind what stands ahead
};

/// "none", "on", "follow", "approach", "stop".
const char* ToString(ManeuverType kind);

struct AlongPlan {
  ManeuverType kind = ManeuverType::kNone;
  FrenetPlan found;  ///< what the method says
  /// The motion, and after it braking until the car stands, at its last offset or, on a track, back
  /// to the route: the car never depends on finding another one. Empty unless something was found.
  std::vector<TrajectoryPoint> points;
  bool to_goal = false;  ///< it ends at the end of the route

  [[nodiscard]] bool ok() const { return kind != ManeuverType::kNone; }
};
void Visit(DiagnosticsVisitor& out, const AlongPlan& along);

/// What is nearest ahead in the car's way along the path: an obstacle whose footprint, seen from
/// the path, comes closer to the car's lane on the path than the safe distance.
struct Leader {
  std::size_t obstacle = 0;  ///< of the request's
  double rear = 0.0;         ///< station of its nearest point now [m]
  double speed = 0.0;        ///< along the path [m/s]
  double left = 0.0;         ///< offsets that it takes up [m]
  double right = 0.0;
};

/// None when nothing is in the way up to the station `to`.
std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to);

/// In this order: to rest at the end of the route, if that is near; on at V, past what is in the
/// way; behind what moves ahead; on more slowly, if that leads past; to rest behind what stands
/// ahead; on for now, as fast as is clear. Passing at V goes first though the cost may rank an
/// offset above a lower speed: slowing down before what stands leads nowhere.
///
/// Guarantees: those of PlanFrenet or PlanLattice for the motion. The braking after it keeps the
/// limits, and the safe distance too, every 0.1 s. On a track it keeps within the edges as well: at
/// the motion's last offset, or back to the route where that one leads off the track. Within 0.05
/// m, it ends no farther than the goal, and beside the route only where two opposite turns of the
/// tightest radius lead back to it before the goal. Same input, same bytes. Does not change route
/// or frame. Errors: InternalError without speed factors, for a wanted speed or gaps out of range,
/// and those of the method. Cost: a few times that of the method.
AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options);

}  // namespace trackbed
