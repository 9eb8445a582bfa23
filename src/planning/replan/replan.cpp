#include "trackbed/planning/replan/replan.h"

#include <algorithm>
#include <cmath>

#include "src/planning/replan/passing.h"
#include "src/planning/replan/stop_planner.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/planning/common/road_hold.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

// Replans while the car drives. If the plan is free of conflicts and the car follows the plan, the
// replanner keeps the plan. If the plan cannot be kept, the replanner first tries to resume the
// route (if the car is back on it), then to proceed along the route or follow a leading obstacle
// (PlanAlongRoute). Next, the replanner tries a detour around static obstacles (PlanDetour), then a
// stop behind an obstacle (PlanAlongRoute). Last, the replanner brakes along the driven plan,
// comfortably if possible, otherwise harder.

namespace trackbed {
namespace {

/// Remaining length of a plan below which the replanner keeps the plan unless it has a conflict
/// [m].
constexpr double kLastMeters = 1.0;
/// Largest deviations from the route at which a car counts as back on the route.
constexpr double kBackOffset = 0.02;     // Tolerance of the distance from the route [m].
constexpr double kBackHeading = 0.005;   // Tolerance of the heading [rad].
constexpr double kBackSteering = 0.002;  // Tolerance of the steering angle [rad].

/// Converts a motion to a plan.
Plan ToPlan(const VehicleParams& vehicle, const std::vector<TrajectoryPoint>& points,
            const Pose2& goal) {
  Plan plan;
  plan.sampled = true;
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
      : request_(request),
        driving_(driving),
        options_(options),
        stops_(request, driving, options) {}

  Replanned Run() {
    auto conflict = NextConflict(driving_.plan.reference, driving_.station);
    if (request_.strayed && !conflict) {
      // Check the plan a second time, shifted sideways by the car's lateral offset from the plan.
      const Pose2 beside = driving_.plan.reference.path.At(driving_.station).pose;
      conflict = NextConflict(driving_.plan.reference, driving_.station,
                              ToLocal(beside, request_.car.pose.position()).y());
    }
    const bool stuck = !driving_.plan.blocked.empty();
    if (!conflict && !stuck && !request_.strayed && (driving_.on_route || IsNearGoal())) {
      return Keep();
    }
    AlongPlan along;
    FeasiblePlan motion;
    if (options_.along) {
      along = Along();
    }
    if (along.ok()) {
      motion = Motion(along);
      along = motion.ok() ? along : AlongPlan{};
    }
    // Do not resume the route while the car follows a leading obstacle, because the route is clear
    // only up to this obstacle.
    if (!driving_.on_route && (!along.ok() || along.kind == ManeuverType::kProceed)) {
      if (auto back = RejoinedRoute()) {
        return std::move(*back);
      }
    }
    if (along.kind == ManeuverType::kProceed || along.kind == ManeuverType::kFollow) {
      return Follow(std::move(motion), along);
    }
    // Keep a plan without conflict, even if no new motion passes the obstacle: the candidate
    // motions depend on their start, so the current plan may succeed where new motions fail.
    const bool is_free = !conflict && !request_.strayed;
    if (is_free && !stuck) {
      return Keep();
    }
    if (options_.detour) {
      Detour detour = FindDetour();
      diagnostics_.detour = FindingsOn(detour);
      // PlanDetour considers only static obstacles, so check the detour against moving obstacles.
      if (detour.route && !NextConflict((*detour.route)->reference, 0.0)) {
        diagnostics_.kind = "detour";
        detour.route->diagnostics().replan = diagnostics_;
        return {ReplanKind::kRoute, std::move(*detour.route)};
      }
    }
    if (is_free && (!along.ok() || along.points.back().distance <= LeftToDrive())) {
      return Keep();
    }
    if (along.ok()) {
      return Follow(std::move(motion), along);
    }
    if (!conflict && request_.strayed) {
      conflict = AheadOfTheCar();
    }
    return conflict ? Brake(*conflict) : Keep();
  }

 private:
  [[nodiscard]] static Replanned Keep() { return {ReplanKind::kKeep, FeasiblePlan()}; }

  /// Checks a new plan against the limits of car and road; the policy `infeasible` decides what
  /// happens if the plan exceeds a limit.
  [[nodiscard]] FeasiblePlan Held(Plan plan, InfeasiblePolicy infeasible,
                                  double deceleration = 0.0) const {
    PlanRequest constrained = RequestOn(request_.road, request_.vehicle, request_.speed);
    constrained.infeasible = infeasible;
    constrained.speed.deceleration = std::max(constrained.speed.deceleration, deceleration);
    return MakeFeasibleFromHere(std::move(plan), constrained);
  }

  /// Returns the policy for infeasible plans that must not be slowed down, because a slower plan
  /// could meet moving obstacles.
  [[nodiscard]] InfeasiblePolicy WithoutSlowingDown() const {
    return request_.road.infeasible == InfeasiblePolicy::kAllow ? InfeasiblePolicy::kAllow
                                                                : InfeasiblePolicy::kRefuse;
  }

  [[nodiscard]] std::optional<PredictedConflict> NextConflict(const Reference& reference,
                                                              double station,
                                                              double offset = 0.0) const {
    return PredictConflict(request_.vehicle, reference, station, request_.obstacles,
                           options_.settings.safe_distance, options_.settings.look_ahead, offset);
  }

  /// Returns the next conflict on the driven plan if the car continues at its actual speed instead
  /// of the planned speed.
  [[nodiscard]] std::optional<PredictedConflict> AheadOfTheCar() const {
    const double speed = request_.car.speed;
    const Plan plan = stops_.StopAfter(
        std::max(LeftToDrive(), 0.0) + 0.5 * speed * speed / stops_.ComfortableBraking(), speed,
        true);
    std::optional<PredictedConflict> conflict = NextConflict(plan.reference, 0.0);
    if (conflict) {
      conflict->station += driving_.station;
    }
    return conflict;
  }

  /// Returns the remaining length of the driven plan [m].
  [[nodiscard]] double LeftToDrive() const {
    return driving_.plan.reference.path.length() - driving_.station;
  }

  [[nodiscard]] bool IsNearGoal() const { return LeftToDrive() < kLastMeters; }

  /// Returns the state at which new motions start: the planned state at the car's station or, if
  /// the car has strayed from the plan, the car's own state.
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

  /// Returns the rest of the route if the car is back on the route and the route is free of
  /// conflicts.
  [[nodiscard]] std::optional<Replanned> RejoinedRoute() const {
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
    FeasiblePlan rest = Held(RemainingPlan(driving_.route, at.s, start.speed, request_.speed),
                             request_.road.infeasible);
    if (!rest.ok() || NextConflict(rest->reference, 0.0)) {
      return std::nullopt;
    }
    rest.diagnostics().replan = ReplanDiagnostics{.kind = "back_on_route"};
    return Replanned{ReplanKind::kRoute, std::move(rest)};
  }

  /// Returns the mission's speed, or a lower speed if a slower stretch of the route is ahead. A
  /// slower stretch is considered if its distance from the car is at most the distance driven in 2
  /// s plus the distance needed to slow down.
  [[nodiscard]] double WantedSpeed(double speed) const {
    constexpr double kSpeedLeadTime = 2.0;  // [s]
    double wanted = request_.speed.speed;
    for (const SpeedCap& cap : CapsOf(driving_.route)) {
      const double down = std::max(
          0.0, (speed * speed - cap.speed * cap.speed) / (2.0 * request_.speed.deceleration));
      const double reach = driving_.route_station + kSpeedLeadTime * speed + down;
      if (cap.from <= reach && driving_.route_station <= cap.to) {
        wanted = std::min(wanted, cap.speed);
      }
    }
    return wanted;
  }

  /// Limits of new motions on the road ahead.
  struct Within {
    SpeedLimits speed;
    AlongOptions options;
  };

  /// Returns the limits of new motions, lowered to the accelerations that the road under the route
  /// ahead permits.
  [[nodiscard]] Within OnThisRoad(double speed) const {
    Within within{request_.speed, *options_.along};
    const double fastest = std::max(speed, request_.speed.speed);
    const double reach = fastest * options_.settings.look_ahead +
                         0.5 * fastest * fastest / request_.speed.deceleration;
    const Path& path = driving_.route.reference.path;
    const RoadHoldLimits hold = MinRoadHold(
        path,
        {driving_.route_station,
         std::max(driving_.route_station, std::min(driving_.route_station + reach, path.length()))},
        RequestOn(request_.road, request_.vehicle, request_.speed));
    const auto lower = [](double& limit, double held) {
      limit = held > 0.0 ? std::min(limit, held) : limit;
    };
    lower(within.speed.acceleration, hold.driving);
    lower(within.speed.deceleration, hold.braking);
    std::visit([&](auto& own) { lower(own.limits.max_lateral_acceleration, hold.lateral); },
               within.options);
    return within;
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
    const Within within = OnThisRoad(start.speed);
    return PlanAlongRoute(driving_.frame,
                          {.vehicle = request_.vehicle,
                           .speed = within.speed,
                           .wanted = WantedSpeed(start.speed),
                           .start = *frenet,
                           .obstacles = request_.obstacles},
                          options_.settings, within.options);
  }

  [[nodiscard]] FeasiblePlan Motion(const AlongPlan& along) const {
    Plan plan = ToPlan(request_.vehicle, along.points, driving_.route.goal);
    if (along.kind == ManeuverType::kStop) {
      plan.blocked = "stops behind the obstacle: no feasible motion past it";
    } else if (!along.to_goal) {
      plan.blocked = "stops: no feasible motion found";
    }
    return Held(std::move(plan), WithoutSlowingDown());
  }

  Replanned Follow(FeasiblePlan motion, const AlongPlan& along) {
    diagnostics_.along = along;
    diagnostics_.kind = "motion";
    motion.diagnostics().replan = diagnostics_;
    return {ReplanKind::kMotion, std::move(motion)};
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
                          .seed = request_.seed,
                          .road = request_.road};
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

  /// Stops along the driven plan before the place of the conflict, even if the road's grip is too
  /// low for the braking force.
  Replanned Brake(const PredictedConflict& conflict) {
    std::optional<BrakingPlan> stop =
        stops_.StopBefore(conflict, std::max(Start().speed, request_.car.speed));
    if (!stop) {
      return Keep();
    }
    diagnostics_.kind = "brake";
    diagnostics_.deceleration = stop->deceleration;
    stop->plan.diagnostics.replan = diagnostics_;
    FeasiblePlan held = Held(stop->plan, request_.road.infeasible, stop->deceleration);
    if (!held.ok()) {
      held = Held(std::move(stop->plan), InfeasiblePolicy::kAllow, stop->deceleration);
    }
    return {ReplanKind::kStop, std::move(held)};
  }

  const ReplanRequest& request_;
  const Driving& driving_;
  const ReplanOptions& options_;
  StopPlanner stops_;
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
  if (own.along) {
    // A slow car must know of an obstacle before the move to the side begins.
    own.settings.look_ahead = std::max(
        own.settings.look_ahead,
        LongestShiftTime(request.vehicle, own.settings.road, *own.along, request.speed.speed));
  }
  return Replanning(request, driving, own).Run();
}

}  // namespace trackbed
