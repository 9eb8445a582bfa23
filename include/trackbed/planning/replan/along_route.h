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

/// Plans the car's next motion along a route, in the route's Frenet frame. If possible, the next
/// motion passes obstacles in the way; otherwise, the car stays behind the obstacles.
///
/// Symbols: as in planning/frenet/frenet.h; V is the desired speed of the car [m/s].
namespace trackbed {

/// Speed below which an obstacle counts as standing, so that the car does not follow this obstacle
/// but passes it [m/s].
inline constexpr double kStandstillSpeed = 0.3;

struct AlongEntry {
  const char* name;
  const char* summary;
  AlongOptions defaults;
};

/// Returns all methods that can find motions along a route.
const std::vector<AlongEntry>& AlongMethods();

/// A route that is prepared for planning motions in the route's Frenet frame. The curvature of the
/// prepared route changes no faster than the wheels can turn at the planned speeds
/// (path/smooth_curvature.h). The prepared route is extended straight by `beyond` [m], so that
/// motions may end beyond the route's end. On a track, the prepared route keeps the route's
/// curvature, which is already continuous. Motions on a track stay within the track's edges.
struct RouteFrame {
  Path path;
  double goal = 0.0;  ///< Station of the end of the route on `path` [m].
  /// Edges of the track relative to `path`; null if the route is not on a track.
  std::shared_ptr<const RoadEdges> edges{};
};

/// Prepares a route for planning motions. On a track, motions keep the distance `edge_distance` [m]
/// from the track's edges. Where the route itself is closer to an edge than `edge_distance`,
/// motions come no closer to this edge than a car on the route (EdgesBeside). Computing time: 10 us
/// per meter of route, on a track 50 us. Throws InternalError if the route has cusps.
RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance = 0.0);

struct AlongRequest {
  VehicleParams vehicle;
  SpeedLimits speed;    ///< Upper limits of the car's speed and accelerations.
  double wanted = 0.0;  ///< Desired speed V of the car [m/s], at most the speed limit.
  FrenetState start;    ///< State of the car in the route's Frenet frame.
  std::vector<MovingBox> obstacles;
};

enum class ManeuverType {
  kNone,  ///< No motion was found.
  /// Continue along the route, past obstacles in the way if any, up to the end of the route.
  kProceed,
  kFollow,  ///< Follow an obstacle that moves ahead of the car.
  /// Continue along the route for now, but not past a standing obstacle; the next motion may be
  /// kStop.
  kApproach,
  kStop,  ///< Stop the car behind a standing obstacle.
};

/// Returns the name of a maneuver type: "none", "on", "follow", "approach", "stop".
const char* ToString(ManeuverType kind);

struct AlongPlan {
  ManeuverType kind = ManeuverType::kNone;
  /// Result of the method that searched for the motion (PlanFrenet or PlanLattice).
  FrenetPlan found;
  /// Points of the motion, and of braking to a standstill after the motion. While braking, the car
  /// keeps the last offset of the motion or, on a track, may return to the route. Because the
  /// points include braking to a standstill, the car can stop safely even if no further motion is
  /// found. The list of points is empty if no motion was found.
  std::vector<TrajectoryPoint> points;
  bool to_goal = false;  ///< Whether the motion leads to the end of the route.
  bool passes = false;   ///< Whether the motion passes an obstacle in the way.
  /// Reason why the car follows its leader instead of passing it; empty unless `kind` is kFollow.
  std::string why{};

  [[nodiscard]] bool ok() const { return kind != ManeuverType::kNone; }
};
void Visit(DiagnosticsVisitor& out, const AlongPlan& along);

/// The nearest obstacle in the car's way along the path. An obstacle is in the way if, in path
/// coordinates, the obstacle's footprint comes closer than the safe distance to the strip that the
/// car covers on the path.
struct Leader {
  std::size_t obstacle = 0;  ///< Index of the obstacle in AlongRequest::obstacles.
  /// Present station of the obstacle's rear end, the point nearest to the car [m].
  double rear = 0.0;
  double speed = 0.0;  ///< Speed of the obstacle along the path [m/s].
  /// Largest offset of the obstacle's footprint from the path [m], positive to the left.
  double left = 0.0;
  double right = 0.0;
  /// Present station of the obstacle's front end [m].
  double front = 0.0;
};

/// Plans the next motion along the route. PlanAlongRoute tries seven motions in a fixed order.
/// Motion 1 stops at the end of the route, if the end is near. Motion 2 continues at the desired
/// speed V, past obstacles in the way. Motion 3 pulls out next to a moving leader that is slower
/// than the desired speed V. The speed of motion 3 is lower than V, but at least the leader's
/// speed. Motion 4 follows a moving leader. Motion 5 continues at a lower speed, if the lower speed
/// lets the car pass the obstacle. Motion 6 stops behind a standing leader. Motion 7 continues for
/// now, as fast as the free space allows. PlanAlongRoute tries to pass an obstacle at the desired
/// speed V first, even if a slower motion costs less, because slowing down does not remove a
/// standing obstacle.
///
/// The car passes a moving leader only if it could finish passing at the desired speed V. After
/// passing the leader, the car must be able to return to the route and brake to a stop before the
/// route's end. The test of passing a leader extrapolates all obstacles at constant velocity. If
/// the car follows its leader instead of passing it, AlongPlan::why states the reason.
///
/// Guarantees: the motion has the guarantees of PlanFrenet or PlanLattice. During the braking after
/// the motion, the car meets the same limits as during the motion and keeps the safe distance,
/// checked every 0.1 s. On a track, the car stays within the track's edges while braking: if the
/// last offset of the motion would lead off the track, the car returns to the route. The motion
/// ends at most 0.05 m beyond the route's end. The motion ends beside the route only if the car can
/// return to the route before the route's end, by two opposite turns of the smallest radius. The
/// same input always yields a bit-identical result. Throws the same exceptions as PlanFrenet or
/// PlanLattice, and InternalError if the options contain no speed factors, or if the desired speed
/// or a gap is out of range. Computing time: a few times the computing time of PlanFrenet or
/// PlanLattice.
AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options);

}  // namespace trackbed
