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
/// possible, else behind them.
///
/// Symbols: those of planning/frenet.h; V desired speed [m/s].
namespace trackbed {

/// Speed below which an obstacle counts as standing: the car passes it rather than following it
/// [m/s].
inline constexpr double kStandstillSpeed = 0.3;

struct AlongEntry {
  const char* name;
  const char* summary;
  AlongOptions defaults;
};

/// All methods to find motions along a route.
const std::vector<AlongEntry>& AlongMethods();

/// The route in the form that motions need: its curvature changes no faster than the wheels can
/// turn at the planned speeds (path/smooth_curvature.h), and it continues straight beyond its end
/// as far as motions may reach, `beyond` [m]. On a track the route is unchanged, because its
/// curvature is continuous, and motions stay within the edges.
struct RouteFrame {
  Path path;
  double goal = 0.0;  ///< station of the route's end [m]
  /// Edges of the track, seen from the path; null elsewhere.
  std::shared_ptr<const RoadEdges> edges{};
};

/// Motions keep `edge_distance` [m] from a track's edges, or the distance of the route itself if
/// that is smaller (EdgesBeside). Cost: 10 us per meter, on a track 50 us. InternalError for a
/// route with cusps.
RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance = 0.0);

struct AlongRequest {
  VehicleParams vehicle;
  SpeedLimits speed;    ///< upper limits on speed and accelerations
  double wanted = 0.0;  ///< V, at most the limits' speed
  FrenetState start;    ///< of the car, relative to the frame
  std::vector<MovingBox> obstacles;
};

enum class ManeuverType {
  kNone,      ///< no motion was found
  kProceed,   ///< continue along the route, past obstacles in the way, or to its end
  kFollow,    ///< behind a moving obstacle
  kApproach,  ///< continue, but not past a standing obstacle; the next motion may be kStop
  kStop,      ///< stop behind a standing obstacle
};

/// "none", "on", "follow", "approach", "stop".
const char* ToString(ManeuverType kind);

struct AlongPlan {
  ManeuverType kind = ManeuverType::kNone;
  FrenetPlan found;  ///< result of the method
  /// The motion, followed by braking to a standstill, at its last offset or, on a track, back on
  /// the route: the car never depends on finding another motion. Empty if none was found.
  std::vector<TrajectoryPoint> points;
  bool to_goal = false;  ///< the motion ends at the end of the route

  [[nodiscard]] bool ok() const { return kind != ManeuverType::kNone; }
};
void Visit(DiagnosticsVisitor& out, const AlongPlan& along);

/// The nearest obstacle in the car's way along the path: one whose footprint, in path coordinates,
/// comes closer to the car's lane on the path than the safe distance.
struct Leader {
  std::size_t obstacle = 0;  ///< index in the request
  double rear = 0.0;         ///< station of its nearest point at present [m]
  double speed = 0.0;        ///< along the path [m/s]
  double left = 0.0;         ///< left end of the offsets that it occupies [m]
  double right = 0.0;
};

/// The leader up to the station `to`; none if the way is clear.
std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to);

/// Tries motions in this order: stop at the end of the route, if that is near; continue at V, past
/// obstacles in the way; follow a moving leader; continue more slowly, if that passes the obstacle;
/// stop behind a standing leader; continue for now, as fast as is clear. Passing at V is tried
/// before slowing down, even though the cost may prefer a lower speed to an offset, because slowing
/// down does not remove a standing obstacle.
///
/// Guarantees: those of PlanFrenet or PlanLattice for the motion. The braking after it meets the
/// limits and the safe distance, checked every 0.1 s. On a track it also stays within the edges: at
/// the motion's last offset, or back on the route if that offset leads off the track. The motion
/// ends at most 0.05 m beyond the goal, and beside the route only if two opposite turns of the
/// tightest radius can return to the route before the goal. The same input gives the same bytes.
/// Does not change route or frame. Errors: InternalError without speed factors, for a desired speed
/// or gaps out of range, and those of the method. Cost: a few times that of the method.
AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options);

}  // namespace trackbed
