#include "trackbed/planning/replan/replan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// A plan that ends at the goal is kept for its last meters, unless something comes in the way.
constexpr double kLastMeters = 1.0;
/// As near as this to the route, a car is back on it.
constexpr double kBackOffset = 0.02;     // [m]
constexpr double kBackHeading = 0.005;   // [rad]
constexpr double kBackSteering = 0.002;  // [rad]
/// No path is shorter than this, unless it has no length [m].
constexpr double kNoWay = 1e-3;
/// Room that is left before an obstacle when the car has to brake for it [m].
constexpr double kBrakeRoom = 0.5;

bool Stands(const MovingBox& box) {
  return box.velocity.norm() < kStandsBelow;
}

std::string Place(const OrientedBox& box) {
  return fmt::format("({:.4g}, {:.4g})", box.center.x, box.center.y);
}

/// A plan that follows a motion.
Plan ToPlan(const VehicleParams& vehicle, const std::vector<TrajectoryPoint>& points,
            const Pose2& goal) {
  Plan plan;
  plan.reference = ToReference(points);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = goal;
  std::vector<SteeringSchedule::Knot> knots;
  for (const TrajectoryPoint& point : points) {
    if (knots.empty() || point.distance > knots.back().distance + 1e-6) {
      knots.push_back({point.distance, SteeringForCurvature(vehicle, point.motion.curvature)});
    }
  }
  plan.schedule = SteeringSchedule::Through(std::move(knots));
  return plan;
}

class Replanning {
 public:
  Replanning(const ReplanRequest& request, const Driving& driving, const ReplanOptions& options)
      : request_(request), driving_(driving), options_(options) {}

  Replanned Run() {
    auto conflict = NextConflict(driving_.plan.reference, driving_.station);
    if (request_.strayed && !conflict) {
      // Beside the plan as far as the car is.
      const Pose2 beside = driving_.plan.reference.path.At(driving_.station).pose;
      conflict = NextConflict(driving_.plan.reference, driving_.station,
                              ToLocal(beside, request_.car.pose.position()).y());
    }
    const bool stuck = !driving_.plan.blocked.empty();
    if (!conflict && !stuck && !request_.strayed && (driving_.on_route || NearlyThere())) {
      return Keep();
    }
    AlongPlan along;
    if (options_.along) {
      along = Along();
    }
    // Behind a leader the route is clear only up to where it is too near.
    if (!driving_.on_route && (!along.ok() || along.kind == ManeuverType::kProceed)) {
      if (auto back = BackOnRoute()) {
        return std::move(*back);
      }
    }
    if (along.kind == ManeuverType::kProceed || along.kind == ManeuverType::kFollow) {
      return Follow(along);
    }
    // Another start has other candidates: what is driven may lead past what none of them do.
    const bool is_free = !conflict && !request_.strayed;
    if (is_free && !stuck) {
      return Keep();
    }
    if (options_.detour) {
      Detour detour = FindDetour();
      diagnostics_.detour = FindingsOn(detour);
      // Detours know only what stands.
      if (detour.route && !NextConflict(detour.route->reference, 0.0)) {
        diagnostics_.kind = "detour";
        detour.route->diagnostics.replan = diagnostics_;
        return {ReplanKind::kRoute, std::move(*detour.route)};
      }
    }
    if (is_free && (!along.ok() || along.points.back().distance <= LeftToDrive())) {
      return Keep();
    }
    if (along.ok()) {
      return Follow(along);
    }
    if (!conflict && request_.strayed) {
      conflict = AheadOfTheCar();
    }
    return conflict ? Brake(*conflict) : Keep();
  }

 private:
  [[nodiscard]] Replanned Keep() const { return {ReplanKind::kKeep, driving_.plan}; }

  [[nodiscard]] std::optional<PredictedConflict> NextConflict(const Reference& reference,
                                                              double station,
                                                              double offset = 0.0) const {
    return PredictConflict(request_.vehicle, reference, station, request_.obstacles,
                           options_.settings.safe_distance, options_.settings.look_ahead, offset);
  }

  /// What a car that drives on at its own speed, not at the planned one, gets too near to.
  [[nodiscard]] std::optional<PredictedConflict> AheadOfTheCar() const {
    const double speed = request_.car.speed;
    const Plan plan = StopAfter(
        std::max(LeftToDrive(), 0.0) + 0.5 * speed * speed / ComfortableBraking(), speed, true);
    std::optional<PredictedConflict> conflict = NextConflict(plan.reference, 0.0);
    if (conflict) {
      conflict->station += driving_.station;
    }
    return conflict;
  }

  /// Of the plan that is driven [m].
  [[nodiscard]] double LeftToDrive() const {
    return driving_.plan.reference.path.length() - driving_.station;
  }

  [[nodiscard]] bool NearlyThere() const { return LeftToDrive() < kLastMeters; }

  /// The planned motion beside the car, or the car's own.
  [[nodiscard]] MotionState Start() const {
    if (request_.strayed) {
      return request_.car;
    }
    const Reference& reference = driving_.plan.reference;
    const PathPoint at = reference.path.At(driving_.station);
    MotionState start{.pose = at.pose,
                      .curvature = at.curvature,
                      .speed = reference.speed.SpeedAt(driving_.station),
                      .acceleration = reference.speed.AccelerationAt(driving_.station)};
    if (request_.car.speed < kAtRestSpeed && start.speed < 10.0 * kAtRestSpeed) {
      start.speed = 0.0;
      start.acceleration = 0.0;
    }
    return start;
  }

  /// The rest of the route, if the motion has come back to it.
  [[nodiscard]] std::optional<Replanned> BackOnRoute() const {
    const MotionState start = Start();
    const Path& path = driving_.route.reference.path;
    constexpr double kSearch = 5.0;  // [m]
    const Projection at = path.Project(
        start.pose, {driving_.route_station - kSearch, driving_.route_station + kSearch});
    const double steering = SteeringForCurvature(request_.vehicle, start.curvature);
    const double on_route = SteeringForCurvature(request_.vehicle, path.At(at.s).curvature);
    if (at.s < 0.0 || at.s > path.length() || std::abs(at.cross_track) > kBackOffset ||
        std::abs(at.heading_error) > kBackHeading ||
        std::abs(steering - on_route) > kBackSteering) {
      return std::nullopt;
    }
    Plan rest = RemainingPlan(driving_.route, at.s, start.speed, request_.speed);
    if (NextConflict(rest.reference, 0.0)) {
      return std::nullopt;
    }
    rest.diagnostics.replan = ReplanDiagnostics{.kind = "back_on_route"};
    return Replanned{ReplanKind::kRoute, std::move(rest)};
  }

  /// The mission's speed, or that of what lies ahead: a slow turn, and the way to slow down to it.
  [[nodiscard]] double WantedSpeed(double speed) const {
    constexpr double kSooner = 2.0;  // [s]
    double wanted = request_.speed.speed;
    for (const SpeedCap& cap : CapsOf(driving_.route)) {
      const double down = std::max(
          0.0, (speed * speed - cap.speed * cap.speed) / (2.0 * request_.speed.deceleration));
      const double reach = driving_.route_station + kSooner * speed + down;
      if (cap.from <= reach && driving_.route_station <= cap.to) {
        wanted = std::min(wanted, cap.speed);
      }
    }
    return wanted;
  }

  [[nodiscard]] AlongPlan Along() const {
    const MotionState start = Start();
    constexpr double kSearch = 10.0;  // [m]
    const auto frenet =
        ToFrenet(driving_.frame.path, start,
                 {driving_.route_station - kSearch, driving_.route_station + kSearch});
    if (!frenet) {
      return {};
    }
    return PlanAlongRoute(driving_.frame,
                          {.vehicle = request_.vehicle,
                           .speed = request_.speed,
                           .wanted = WantedSpeed(start.speed),
                           .start = *frenet,
                           .obstacles = request_.obstacles},
                          options_.settings, *options_.along);
  }

  Replanned Follow(const AlongPlan& along) {
    Plan plan = ToPlan(request_.vehicle, along.points, driving_.route.goal);
    diagnostics_.along = along;
    diagnostics_.kind = "motion";
    plan.diagnostics.replan = diagnostics_;
    if (along.kind == ManeuverType::kStop) {
      plan.blocked = "stops behind the obstacle: no feasible motion past it";
    } else if (!along.to_goal) {
      plan.blocked = "stops: no feasible motion found";
    }
    return {ReplanKind::kMotion, std::move(plan)};
  }

  [[nodiscard]] Detour FindDetour() const {
    DetourRequest request{.vehicle = request_.vehicle,
                          .speed = request_.speed,
                          .driven = driving_.plan,
                          .station = driving_.station,
                          .station_speed = Start().speed,
                          .route = driving_.route,
                          .route_station = driving_.route_station,
                          .obstacles = {},
                          .safe_distance = options_.settings.safe_distance,
                          .wind = request_.wind,
                          .time = request_.time,
                          .seed = request_.seed};
    for (const MovingBox& obstacle : request_.obstacles) {
      if (Stands(obstacle)) {
        request.obstacles.push_back(obstacle.box);
      }
    }
    return PlanDetour(request, *options_.detour, options_.comparator.value_or(DetourChoice{}));
  }

  [[nodiscard]] DetourFindings FindingsOn(const Detour& detour) const {
    DetourFindings found{.planner = PlannerFor(*options_.detour).name,
                         .tried = detour.tried,
                         .current = detour.current,
                         .best = std::nullopt,
                         .why = detour.why};
    if (std::isfinite(detour.best.total)) {
      found.best = detour.best;
    }
    if (detour.route) {
      found.replaced = detour.replaced;
    }
    return found;
  }

  /// Along the plan that is driven, to rest before the place of the conflict: comfortably if that
  /// is in time, else as hard as it takes, else as hard as the car can.
  Replanned Brake(const PredictedConflict& conflict) {
    const MovingBox& obstacle = request_.obstacles[conflict.obstacle];
    const double speed = std::max(Start().speed, request_.car.speed);
    const double room = conflict.station - driving_.station - kBrakeRoom;
    const double braking = Stands(obstacle) ? BrakingWithin(room, speed) : BrakingFor(speed);
    const double shortest = speed * speed / (2.0 * braking);
    const bool comfortable = braking <= ComfortableBraking();
    // What stands leaves time to come near; what moves may be gone or come nearer.
    const double way = Stands(obstacle) && comfortable ? std::max(shortest, room) : shortest;
    if (way < kNoWay && LeftToDrive() < kNoWay) {
      return Keep();  // it ends here anyway
    }
    Plan plan = StopAfter(way, speed, comfortable);
    if (!Stands(obstacle) && !PutsOff(plan, conflict)) {
      return Keep();
    }
    plan.goal = driving_.route.goal;
    plan.blocked =
        fmt::format("stops before the obstacle at {}: no path around it", Place(obstacle.box));
    diagnostics_.kind = "brake";
    diagnostics_.deceleration = braking;
    plan.diagnostics.replan = diagnostics_;
    return {ReplanKind::kStop, std::move(plan)};
  }

  /// Whether the car that follows `plan` has more time before it gets too near to something than
  /// with the conflict that it brakes for. What comes from behind reaches it the sooner.
  [[nodiscard]] bool PutsOff(const Plan& plan, const PredictedConflict& conflict) const {
    const auto braked = NextConflict(plan.reference, 0.0);
    return !braked || braked->time >= conflict.time;
  }

  /// Hard braking is never more than this; on ice, the comfortable one neither [m/s^2].
  [[nodiscard]] double HardestBraking() const {
    return request_.max_deceleration > 0.0 ? request_.max_deceleration
                                           : request_.speed.deceleration;
  }

  [[nodiscard]] double ComfortableBraking() const {
    return std::min(request_.speed.deceleration, HardestBraking());
  }

  /// The deceleration that comes to rest within `room` from `speed`, no less than the comfortable
  /// one and no more than the hardest.
  [[nodiscard]] double BrakingWithin(double room, double speed) const {
    const double needed = 0.5 * speed * speed / std::max(room, kNoWay);
    return std::min(std::max(needed, ComfortableBraking()), HardestBraking());
  }

  /// The mildest braking that keeps clear of everything known, what moves too; else the hardest.
  [[nodiscard]] double BrakingFor(double speed) const {
    const double hardest = HardestBraking();
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      const double braking =
          std::lerp(ComfortableBraking(), hardest, static_cast<double>(i) / kSteps);
      const Plan plan = StopAfter(0.5 * speed * speed / braking, speed, i == 0);
      if (!NextConflict(plan.reference, 0.0)) {
        return braking;
      }
    }
    return hardest;
  }

  /// From `speed` beside the car to rest after `way` along the driven plan; or, comfortably, at its
  /// end if that is nearer.
  [[nodiscard]] Plan StopAfter(double way, double speed, bool comfortable) const {
    const Path& path = driving_.plan.reference.path;
    const double from = driving_.station;
    const double shortest = 0.5 * speed * speed / ComfortableBraking();
    double to = from + way;
    if (comfortable && to > path.length()) {
      to = std::max(path.length(), from + shortest);
    }
    Plan plan;
    plan.reference.path =
        Path(path.At(from).pose,
             to - from < kNoWay ? std::vector<Segment>{} : SegmentsBetween(path, {from, to}));
    const Path& own = plan.reference.path;
    // Caps are for a car that drives on; hard braking obeys them anyway or cannot.
    plan.caps =
        comfortable ? Moved(CapsOf(driving_.plan), {from, to}, -from) : std::vector<SpeedCap>{};
    SpeedLimits limits = request_.speed;
    limits.deceleration = ComfortableBraking();
    plan.reference.speed = StopAtEnd(own.length(), speed, limits, plan.caps);
    plan.schedule = own.length() > 0.0
                        ? CourseSchedule(request_.vehicle, own.segments(),
                                         std::max(request_.speed.speed, speed), plan.caps)
                        : SteeringSchedule::Constant(
                              SteeringForCurvature(request_.vehicle, path.At(from).curvature));
    plan.schedule_speed = plan.reference.speed;
    return plan;
  }

  const ReplanRequest& request_;
  const Driving& driving_;
  const ReplanOptions& options_;
  ReplanDiagnostics diagnostics_;
};

}  // namespace

void Visit(DiagnosticsVisitor& out, const ReplanDiagnostics& own) {
  out.Text("kind", own.kind);
  if (own.along) {
    out.Section("along", *own.along);
  }
  if (own.detour) {
    out.Section("detour", *own.detour);
  }
  if (own.deceleration) {
    out.Number("deceleration_mps2", *own.deceleration);
  }
}

const char* ToString(ReplanKind kind) {
  switch (kind) {
    case ReplanKind::kKeep:
      return "keep";
    case ReplanKind::kMotion:
      return "motion";
    case ReplanKind::kRoute:
      return "route";
    case ReplanKind::kStop:
      return "stop";
  }
  return "keep";
}

Replanned Replan(const ReplanRequest& request, const Driving& driving,
                 const ReplanOptions& options) {
  TRACKBED_CHECK((options.along || options.detour) && driving.plan.ok() && driving.route.ok(),
                 "needs a planner and an initial plan");
  ReplanOptions own = options;
  own.settings.look_ahead = std::max(
      own.settings.look_ahead, request.speed.speed / request.speed.deceleration + 2.0 * own.period);
  return Replanning(request, driving, own).Run();
}

}  // namespace trackbed
