#include "trackbed/planning/grid/hybrid_astar_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "src/planning/curves/continuous_or_steps.h"
#include "src/planning/curves/continuous_route.h"
#include "src/planning/curves/detours.h"
#include "src/planning/grid/clothoid_costs.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan_comparison.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/curves/drivable_curve.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"

// The planner `hybrid_astar`: one search (hybrid_astar.h) for each leg between two stops.
// 1. PlanArcs searches with arcs. The curvature steps between arcs, so the plan slows down or stops
//    there.
// 2. PlanClothoids searches with arcs and clothoids, which the steering can follow.
// 3. A rolling car drives its first leg at once along a Dubins curve, or by a search that begins
//    where the car has slowed down. Of the Dubins curve and the path of the search, the planner
//    takes the shorter one.
// 4. With curvature `auto`, the planner makes a plan by PlanArcs and a plan by PlanClothoids, and
//    ContinuousOrSteps chooses one. For `auto`, the search with clothoids has a budget, because it
//    is about ten times as slow.
// 5. If a rolling car would drive a detour, the curves of `dubins` are tried, too.
// Source: Dolgov et al. 2010.
namespace trackbed {
namespace {

using route::CheckPoses;
using route::CheckRadius;
using route::IsFree;
using route::LeadInForCurves;
using route::RadiusFor;
using route::Refused;

double Length(const std::vector<Segment>& segments) {
  return std::accumulate(segments.begin(), segments.end(), 0.0,
                         [](double sum, const Segment& segment) { return sum + segment.length; });
}

/// Data that the plans of all legs need.
struct Route {
  const HybridAStarOptions& options;
  const PlanRequest& request;
  std::vector<Pose2> stops;
  CurveDrive drive;
  CollisionChecker clear;
};

/// Returns the initial curvature of the leg after stop `i`, if no obstacle is in its way.
PathBend BendAfter(const Route& route, std::size_t i) {
  if (i + 1 == route.stops.size()) {
    return {};
  }
  const ShortestCurve next =
      route.options.reverse ? ReedsShepp(route.stops[i], route.stops[i + 1], route.drive.radius)
                            : Dubins(route.stops[i], route.stops[i + 1], route.drive.radius);
  return FirstBend(route.request.vehicle, next, route.drive);
}

HybridAStarResult SearchLeg(const Route& route, const Pose2& from, std::size_t to,
                            const PathBend& before, bool rolls) {
  CurveDrive drive = route.drive;
  drive.before = before;
  drive.after = BendAfter(route, to);
  return SearchHybridAStar(route.request.vehicle,
                           {.start = from,
                            .goal = route.stops[to],
                            .obstacles = route.request.obstacles,
                            .rolls = rolls,
                            .drive = drive},
                           route.options);
}

/// Plans the shortest curve forwards to the first stop for a rolling car, once its wheels are
/// straight. The car must be able to follow the curve without a stop, and the curve must be free.
HybridAStarResult RollAtOnce(const Route& route) {
  const PlanRequest& request = route.request;
  const LeadIn lead = ComputeLeadIn(request, request.start_speed, 0.0);
  CurveDrive drive = route.drive;
  drive.speed = std::max(drive.speed, request.start_speed);
  drive.start_speed = request.start_speed;
  drive.deceleration = request.speed.deceleration;
  drive.after = BendAfter(route, 1);
  const std::vector<Segment> curve =
      DrivablePieces(request.vehicle, lead.end, route.stops[1],
                     Dubins(lead.end, route.stops[1], drive.radius), drive);
  HybridAStarResult result;
  result.segments = lead.segments;
  AppendPieces(result.segments, curve);
  if (CanStartRolling(request, 0.0, curve, drive.min_speed) &&
      PlanSteps(request.vehicle, curve, drive.min_speed).stops.empty() &&
      IsFree(route.clear, request.start, result.segments)) {
    result.status = PlanStatus::kOk;
    result.cost = Path(request.start, result.segments).length();
  }
  return result;
}

/// Plans from the first stop to the second for a rolling car: at once, or by a search that begins
/// where the car has slowed down for its first turn. Takes the shorter path.
HybridAStarResult FirstRollingLeg(const Route& route) {
  const PlanRequest& request = route.request;
  HybridAStarResult at_once = RollAtOnce(route);
  const LeadIn lead = LeadInForCurves(request, route.drive.radius, route.drive.min_speed);
  HybridAStarResult found;
  if (IsFree(route.clear, request.start, lead.segments)) {
    found = SearchLeg(route, lead.end, 1, LastBend(lead.segments), true);
    found.reason = "from waypoint 0 to 1: " + found.reason;
  } else {
    found.status = PlanStatus::kStartBlocked;
    found.reason = fmt::format(
        "an obstacle is too close to the first {:.3g} m, in which the car slows down for its first "
        "turn; at rest (mission.start.speed: 0), it needs no such length",
        lead.length);
  }
  // The length on which the car slows down counts twice: the car needs up to twice the time.
  if (at_once.ok() && at_once.cost <= 2.0 * lead.length + found.cost) {
    return at_once;
  }
  std::vector<Segment> segments = lead.segments;
  AppendPieces(segments, found.segments);
  found.segments = std::move(segments);
  return found;
}

/// Returns the speeds and limits with which the car drives a path of continuous curvature through
/// the stops of a request.
ClothoidDrive DriveOf(const HybridAStarOptions& options, const PlanRequest& request) {
  const VehicleParams& car = request.vehicle;
  ClothoidDrive drive{.speed = std::max(request.speed.speed, options.min_speed),
                      .min_speed = options.min_speed,
                      .steering_rate = options.max_steering_rate_fraction * car.steering_rate,
                      .lateral_acceleration = LateralAccelerationOnClothoids(
                          car, request.friction, options.max_lateral_acceleration),
                      .acceleration = request.speed.acceleration,
                      .deceleration = request.speed.deceleration};
  return drive;
}

/// Returns the speeds and limits with which the car drives the leg to stop `i`.
ClothoidDrive DriveOfLeg(ClothoidDrive drive, const PlanRequest& request, std::size_t i,
                         std::size_t stops) {
  drive.rests_at_start = i == 1 && request.start_speed == 0.0;
  drive.rests_at_goal = i + 1 == stops;
  if (i == 1 && request.start_speed > 0.0) {
    drive.start_speed = request.start_speed;
    drive.start_curvature = CurvatureForSteering(request.vehicle, request.start_steering);
    // The length on which the car can stop is longer on a slippery road.
    const double stopping = ComputeLeadIn(request, 0.0, 0.0).length -
                            ComputeLeadIn(request, request.start_speed, 0.0).length;
    drive.deceleration = 0.5 * request.start_speed * request.start_speed / stopping;
  }
  return drive;
}

/// Plans a path of continuous curvature.
Plan PlanClothoids(const HybridAStarOptions& options, const PlanRequest& request) {
  const std::vector<Pose2> stops = PlannedStops(request);
  const ClothoidDrive drive = DriveOf(options, request);
  Plan plan;
  HybridAStarDiagnostics diagnostics;
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const ClothoidDrive own = DriveOfLeg(drive, request, i, stops.size());
    const HybridAStarResult found = SearchHybridAStar(request.vehicle,
                                                      {.start = stops[i - 1],
                                                       .goal = stops[i],
                                                       .obstacles = request.obstacles,
                                                       .rolls = own.start_speed > 0.0,
                                                       .clothoids = own},
                                                      options);
    if (!found.ok()) {
      return Refused(found.status,
                     fmt::format("from waypoint {} to {}: {}", i - 1, i, found.reason));
    }
    const ClothoidCosts costs(request.vehicle, options, own,
                              RadiusFor(request.vehicle, options.radius));
    double station = Length(segments);
    for (const Segment& segment : found.segments) {
      if (const double speed = costs.SpeedOn(segment); speed < drive.speed) {
        plan.caps.push_back({station, station + segment.length, speed});
      }
      station += segment.length;
      segments.push_back(segment);
    }
    diagnostics.legs.push_back(
        {.cost = found.cost, .expansions = found.expansions, .cells = found.cells});
  }
  plan.diagnostics.planner = std::move(diagnostics);
  plan.reference.path = Path(request.start, std::move(segments));
  route::Complete(plan, request);
  return plan;
}

/// Plans a path of arcs and straights.
Plan PlanArcs(const HybridAStarOptions& options, const PlanRequest& request) {
  const Route route{.options = options,
                    .request = request,
                    .stops = PlannedStops(request),
                    .drive = {.speed = std::max(request.speed.speed, options.min_speed),
                              .min_speed = options.min_speed,
                              .radius = RadiusFor(request.vehicle, options.radius),
                              .road = request.friction},
                    .clear = route::CheckerFromStart(request, options.safe_distance)};
  Plan plan;
  HybridAStarDiagnostics diagnostics;
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < route.stops.size(); ++i) {
    const bool rolls = i == 1 && request.start_speed > 0.0;
    HybridAStarResult found =
        rolls ? FirstRollingLeg(route)
              : SearchLeg(route, route.stops[i - 1], i, LastBend(segments), false);
    if (!found.ok()) {
      return Refused(
          found.status,
          rolls ? found.reason : fmt::format("from waypoint {} to {}: {}", i - 1, i, found.reason));
    }
    AppendPieces(segments, found.segments);
    diagnostics.legs.push_back(
        {.cost = found.cost, .expansions = found.expansions, .cells = found.cells});
  }
  plan.diagnostics.planner = std::move(diagnostics);
  return route::AlongSegments(std::move(plan), request, std::move(segments), options.min_speed);
}

/// Number of poses that a search for a path of continuous curvature may expand beyond those of the
/// search with steps. Expanding a pose with clothoids takes 100 us instead of 10 us. If the search
/// for continuous curvature finds no path, it takes at most ten times as long as the search with
/// steps, plus 0.6 s.
constexpr int kClothoidPoses = 6000;

/// Returns the number of poses that the searches for a plan expanded.
int Expansions(const Plan& plan) {
  int sum = 0;
  if (const auto* own = plan.diagnostics.planner.GetIf<HybridAStarDiagnostics>()) {
    for (const HybridAStarLeg& leg : own->legs) {
      sum += leg.expansions;
    }
  }
  return sum;
}

Plan PlanOnce(const HybridAStarOptions& options, const PlanRequest& request) {
  for (Plan refused : {CheckPoses(request), CheckRadius(request.vehicle, options.radius)}) {
    if (!refused.ok()) {
      return refused;
    }
  }
  switch (options.curvature) {
    case CurveCurvature::kSteps:
      return PlanArcs(options, request);
    case CurveCurvature::kContinuous:
    case CurveCurvature::kCuspSteps:
      return PlanClothoids(options, request);
    case CurveCurvature::kAuto:
      break;
  }
  Plan steps = PlanArcs(options, request);
  if (!steps.ok() && request.start_speed == 0.0) {
    return steps;
  }
  HybridAStarOptions own = options;
  own.curvature = CurveCurvature::kCuspSteps;
  own.budget = std::min(own.budget, kClothoidPoses + Expansions(steps));
  // Near obstacles, a path that is driven without steps of the curvature is worth some time.
  constexpr double kMostTime = 1.2;
  return ContinuousOrSteps(PlanClothoids(own, request), std::move(steps), request, kMostTime);
}

/// Plans the shortest forward curves through the stops. The curves may be bent at waypoints, where
/// the legs of the search are straight.
Plan PlanForwards(const HybridAStarOptions& options, const PlanRequest& request) {
  DubinsOptions curves{.radius = options.radius,
                       .safe_distance = options.safe_distance,
                       .min_speed = options.min_speed,
                       .max_lateral_acceleration = options.max_lateral_acceleration,
                       .max_steering_rate_fraction = options.max_steering_rate_fraction};
  curves.curvature = options.curvature == CurveCurvature::kCuspSteps ? CurveCurvature::kContinuous
                                                                     : options.curvature;
  return DubinsPlanner().plan(request, curves);
}

Plan PlanWith(const HybridAStarOptions& options, const PlanRequest& request) {
  const CurveLength forwards = [](const Pose2& from, const Pose2& to, double radius) {
    return Dubins(from, to, radius).length;
  };
  Plan found = WithoutDetours(request, options.reverse ? CurveLength(ReedsSheppLength) : forwards,
                              {[&](const PlanRequest& own) { return PlanOnce(options, own); }});
  // FasterRoute makes the curvature linear on 16 parts of each ramp of the steering. On a part, the
  // steering rate exceeds that of the ramp by up to 2 %.
  constexpr double kRateOfParts = 1.02;
  // The search plans one leg at a time, so a rolling car may drive a detour to turn.
  if (request.start_speed > 0.0 && IsDetour(found, request)) {
    PlanRequest slow_wheels = request;
    slow_wheels.vehicle.steering_rate *=
        std::min(1.0, kRateOfParts * options.max_steering_rate_fraction);
    slow_wheels.infeasible = InfeasiblePolicy::kRefuse;
    Plan curves = PlanForwards(options, request);
    if (MakeFeasible(curves, slow_wheels).ok() &&
        IsShorterAndNotSlower(curves, found, request.vehicle)) {
      return curves;
    }
  }
  return found;
}

bool MayReverse(const PlannerOptions& options) {
  return options.Get<HybridAStarOptions>().reverse;
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const HybridAStarLeg& leg) {
  out.Number("cost_m", leg.cost);
  out.Integer("expansions", leg.expansions);
  out.Integer("cells", leg.cells);
}

void Visit(DiagnosticsVisitor& out, const HybridAStarDiagnostics& own) {
  out.List("legs", own.legs);
}

PlannerEntry HybridAStarPlanner() {
  return {
      .name = "hybrid_astar",
      .summary =
          "hybrid A* around obstacles through kinematically feasible poses, forward and reverse",
      .defaults = HybridAStarOptions{},
      .plan = PlanBy<HybridAStarOptions, PlanWith>,
      .min_waypoints = 2,
      .keeps_clear = true,
      .has_headings = true,
      .goes_backwards = true,
      .searches = true,
      .may_go_backwards = MayReverse,
      .detour_defaults = HybridAStarOptions{.radius = {}, .reverse = false}};
}

}  // namespace trackbed
