#include "trackbed/planning/avoidance/avoidance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "src/planning/avoidance/avoidance_listing.h"
#include "src/planning/avoidance/avoidance_stretch.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/open_loop.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/planning/common/road_hold.h"
#include "trackbed/world/world.h"

// Local planners replace the stretches of a plan that come too close to obstacles. In each round,
// the planner finds the first conflict with an obstacle and asks the configured method for a curve
// past the obstacle. The method `listing` uses the curve of Skackauskas (dissertation, listing F.2)
// as printed. The method `bezier` changes a curve until the curve is feasible. The planner inserts
// path, steering schedule, speed caps and diagnostics of the curve into the plan. After a curve was
// inserted, the search for the next conflict continues beyond it. If the method finds no curve, the
// plan stops before the obstacle.

namespace trackbed {
namespace {

using avoidance::Conflict;
using avoidance::CurveCheck;
using avoidance::FirstConflict;
using avoidance::kPathCheckSpacing;
using avoidance::Replacement;
using avoidance::ReplacementSearch;
using avoidance::Stretch;
using avoidance::StretchSearch;

/// Spacing of the path pieces that approximate the curve [m].
constexpr double kCurveSpacing = 0.1;
/// Length of the steering ramp before and after a curve whose curvature differs from that of the
/// plan [m].
constexpr double kStep = 1e-6;

/// Returns whether the curvature jumps from the plan to the end point `curve` of a sampled curve. A
/// curvature change counts as a jump if it exceeds the change from the end point to the next sample
/// `next`.
bool Jumps(const PathPoint& plan, const CurvePoint& curve, const CurvePoint& next) {
  constexpr double kRounding = 1e-9;  // [1/m]
  return std::abs(plan.curvature - curve.curvature) >
         std::max(kRounding, std::abs(next.curvature - curve.curvature));
}

/// Function that finds a curve past an obstacle; the curve leaves the plan at the station `from` or
/// later.
using FindCurve =
    std::function<ReplacementSearch(const Plan& plan, const Conflict& conflict, double from)>;

/// Replaces each stretch of the plan that comes closer than the safe distance SD to an obstacle.
class AroundObstacles {
 public:
  AroundObstacles(const AvoidanceRequest& request, double safe_distance, FindCurve find)
      : request_(request),
        safe_distance_(safe_distance),
        find_(std::move(find)),
        plan_(request.plan) {}

  Plan Run() {
    double from = request_.station;
    if (request_.car) {
      StartAtCar();
      from = 0.0;
    }
    plan_.blocked.clear();
    for (std::size_t round = 0;; ++round) {
      const std::optional<Conflict> conflict =
          FirstConflict(request_, safe_distance_, plan_.reference.path, from);
      if (!conflict) {
        break;
      }
      // Each round makes the plan clear of one obstacle, unless the curve past one obstacle
      // conflicts with another obstacle and vice versa.
      ReplacementSearch found{std::nullopt, "the curves around other obstacles lead back to it"};
      if (round < 2 * request_.obstacles.size()) {
        found = find_(plan_, *conflict, from);
      }
      if (!found.replacement) {
        StopBefore(*conflict, from, found.why);
        break;
      }
      from = Replace(*found.replacement, conflict->obstacle);
    }
    if (!plan_.diagnostics.avoided.empty() || !plan_.blocked.empty()) {
      PredictOpenLoop();
    }
    return plan_;
  }

 private:
  [[nodiscard]] const Path& path() const { return plan_.reference.path; }

  /// Cuts off the part of the plan behind the car, so that stations are counted from the car.
  void StartAtCar() {
    plan_ = RemainingPlan(plan_, request_.station, request_.station_speed, request_.speed);
    // Clear the stations of earlier curves, which refer to the part of the plan that was cut off.
    plan_.diagnostics.avoided.clear();
    plan_.tree.clear();
    MoveDiagnostics({-1.0, -1.0}, -request_.station);
  }

  /// If the plan's speeds are at the car's limit, converts the speeds to speed caps, which remain
  /// valid when the plan's path changes.
  void SpeedsToCaps() {
    plan_.caps = CapsOf(plan_);
    plan_.diagnostics.speed_profile.reset();
  }

  void SetSpeed(double start_speed, double open_loop_end) {
    plan_.stops.clear();  // The new speed profile has no stops.
    plan_.waits.clear();
    plan_.reference.speed = StopAtEnd(path().length(), start_speed, request_.speed, plan_.caps);
    plan_.schedule_speed = StopAtEnd(open_loop_end, start_speed, request_.speed, plan_.caps);
  }

  /// Replaces the plan between the curve's stations by the curve. Returns the station at which the
  /// curve rejoins the old path.
  double Replace(const Replacement& replacement, const OrientedBox& obstacle) {
    SpeedsToCaps();
    const Path old = path();
    const double leave = replacement.stations.from;
    const auto points = replacement.curve.Points(kCurveSpacing, replacement.start.yaw);
    const double back = leave + points.back().s;
    // Length that the curve adds to all stations beyond it [m].
    const double shift = back - replacement.stations.to;
    const Stations before{0.0, leave};
    const Stations after{replacement.stations.to, std::numeric_limits<double>::infinity()};

    std::vector<Segment> segments = old.Cut(before);
    Append(segments, SegmentsThrough(points));
    Append(segments, old.Cut(after));
    // A curve that begins at the car starts at the car's actual pose, not at the planned pose.
    const Pose2 start = leave > 0.0 ? old.At(0.0).pose : replacement.start;
    plan_.reference.path = Path(start, std::move(segments));

    const std::size_t last = points.size() - 1;
    const bool jumps_in = leave > kStep && Jumps(old.At(leave), points[0], points[1]);
    const bool jumps_out = Jumps(old.At(after.from), points[last], points[last - 1]);
    const double step_in = jumps_in ? kStep : 0.0;
    const double step_out = jumps_out ? kStep : 0.0;
    std::vector<SteeringSchedule::Knot> knots = Moved(plan_.schedule, {-1.0, leave - step_in}, 0.0);
    if (jumps_in) {
      knots.push_back({leave - step_in, plan_.schedule.At(leave)});
    }
    for (const CurvePoint& point : points) {
      knots.push_back({leave + point.s, SteeringForCurvature(request_.vehicle, point.curvature)});
    }
    // At each end of the curve without a curvature jump, use the plan's steering angle, so that the
    // steering schedule outside the curve stays exactly unchanged.
    if (leave > kStep && !jumps_in) {
      knots[knots.size() - points.size()].steering = plan_.schedule.At(leave);
    }
    if (jumps_out) {
      knots.push_back({back + step_out, plan_.schedule.At(after.from)});
    } else {
      knots.back().steering = plan_.schedule.At(after.from);
    }
    Append(knots, Moved(plan_.schedule, {after.from + step_out, after.to}, shift));
    plan_.schedule = SteeringSchedule::Through(std::move(knots));

    std::vector<SpeedCap> caps = Moved(plan_.caps, before, 0.0);
    if (replacement.speed < request_.speed.speed) {
      caps.push_back({leave, back, replacement.speed});
    }
    Append(caps, Moved(plan_.caps, after, shift));
    plan_.caps = caps;

    std::vector<IsolatedTurn> turns = Moved(plan_.turns, before, 0.0);
    Append(turns, Moved(plan_.turns, after, shift));
    plan_.turns = turns;

    SetSpeed(plan_.reference.speed.SpeedAt(0.0), plan_.schedule_speed.knots().back().s + shift);
    MoveDiagnostics(replacement.stations, shift);
    Record(replacement, obstacle, {leave, back});
    return back;
  }

  /// Shifts the stations in the diagnostics to the stations of the new path.
  void MoveDiagnostics(const Stations& replaced, double shift) {
    for (MethodDiagnostics& turn : plan_.diagnostics.turns) {
      ReplaceStretch(turn, replaced, shift);
    }
    ReplaceStretch(plan_.diagnostics.planner, replaced, shift);
  }

  void PredictOpenLoop() {
    const double stop = plan_.schedule_speed.knots().back().s;
    plan_.diagnostics.stop_distance = stop;
    plan_.diagnostics.open_loop = SimulateOpenLoop(request_.vehicle, path(), plan_.schedule, stop);
  }

  /// Adds the replaced stretch to the plan's tree, notes and diagnostics.
  void Record(const Replacement& replacement, const OrientedBox& obstacle, const Stations& curve) {
    const std::size_t first = plan_.tree.size();
    for (TreeNode node : replacement.tree) {
      node.parent += first;
      plan_.tree.push_back(node);
    }
    plan_.notes.insert(plan_.notes.end(), replacement.notes.begin(), replacement.notes.end());
    // Simulate the car in open loop from the start of the curve (sig1), steered only by the curve's
    // schedule.
    const PathPoint start = path().At(curve.from);
    const PathPoint end = path().At(curve.to);
    const std::vector<SteeringSchedule::Knot> own =
        Moved(plan_.schedule, {curve.from - 1e-6, curve.to + 1e-6}, -curve.from);
    const KinematicState driven =
        RollOut(request_.vehicle,
                {.pose = start.pose,
                 .speed = replacement.speed,
                 .steering = SteeringForCurvature(request_.vehicle, start.curvature)},
                SteeringSchedule::Through(own), curve.to - curve.from, kCurveSpacing);
    const CurveCheck& check = replacement.check;
    plan_.diagnostics.avoided.push_back(
        {.method = replacement.diagnostics(plan_, curve),
         .obstacle = obstacle.center.position(),
         .passing_side = replacement.passing_side,
         .stations = curve,
         .speed = replacement.speed,
         .length = check.length,
         .clearance = check.clearance,
         .steering_max = check.steering,
         .steering_rate_max = check.steering_rate,
         .lateral_acceleration_max = check.lateral_acceleration,
         .control_points = replacement.curve.control_points(),
         .end_distance = (driven.pose.position() - end.pose.position()).norm(),
         .end_heading_error = AngleDifference(driven.pose.yaw, end.pose.yaw)});
  }

  /// Ends the plan where the obstacle comes closer than the safe distance SD. If the car cannot
  /// stop before it comes too close to the obstacle, ends the plan at the car's stopping distance.
  void StopBefore(const Conflict& conflict, double from, const std::string& why) {
    SpeedsToCaps();
    const double start_speed = plan_.reference.speed.SpeedAt(0.0);
    const double speed = plan_.reference.speed.SpeedAt(from);
    // A car that is already too close to the obstacle brakes with twice the usual deceleration, or
    // as hard as the road permits.
    const RoadHoldLimits hold =
        MinRoadHold(path(), {from, std::max(from, conflict.to)},
                    RequestOn(request_.road, request_.vehicle, request_.speed));
    const double twice = 2.0 * request_.speed.deceleration;
    const double hardest = hold.braking > 0.0 ? std::min(twice, hold.braking) : twice;
    const double shortest = std::max(speed * speed / (2.0 * hardest), kPathCheckSpacing);
    const Stations before{0.0, std::max(conflict.from - kPathCheckSpacing, from + shortest)};
    plan_.reference.path = Path(path().At(0.0).pose, path().Cut(before));
    plan_.caps = Moved(plan_.caps, before, 0.0);
    plan_.turns = Moved(plan_.turns, before, 0.0);
    SetSpeed(start_speed, path().length());
    const Vec2 obstacle = conflict.obstacle.center.position();
    plan_.blocked = fmt::format("stops before the obstacle at ({:.4g}, {:.4g}): {}", obstacle.x(),
                                obstacle.y(), why);
  }

  const AvoidanceRequest& request_;
  double safe_distance_;  ///< Required safe distance SD [m].
  FindCurve find_;
  Plan plan_;
};

BezierAvoidanceDiagnostics DiagnosticsOn(const Stretch& stretch, const AvoidanceRequest& request,
                                         const BezierAvoidanceOptions& options, const Plan& plan,
                                         const Stations& curve) {
  const double share = (stretch.beside - stretch.leave) / (stretch.back - stretch.leave);
  const double beside = stretch.repair.check.length * share;
  const Vec2 point =
      plan.reference.path.At(curve.from + std::max(beside - 2.0, 0.0)).pose.position();
  double corner = std::numeric_limits<double>::infinity();
  for (const Vec2& p : stretch.obstacle.Corners()) {
    corner = std::min(corner, (p - point).norm());
  }
  return {
      .curves_tried = stretch.tried,
      .tree_status = stretch.tree.status,
      .tree_iterations = stretch.tree.iterations,
      .tree_nodes = stretch.tree.nodes.size(),
      .tree_cost = stretch.tree.cost,
      .tree_path = stretch.tree.path,
      .search_method = SearchFor(options.search.method).name,
      .search_evaluations = stretch.repair.search.evaluations,
      .search_objective = stretch.repair.search.value,
      .one_point_check = {.distance = corner,
                          .passed = corner >= options.safe_distance + 0.5 * request.vehicle.width}};
}

/// Checks a plan around obstacles against the limits of car and road, with the given policy for
/// infeasible plans.
FeasiblePlan MakeFeasibleOnRoad(Plan plan, const AvoidanceRequest& request,
                                InfeasiblePolicy infeasible) {
  PlanRequest constrained = RequestOn(request.road, request.vehicle, request.speed);
  constrained.infeasible = infeasible;
  return MakeFeasibleFromHere(std::move(plan), constrained);
}

/// Plans a path past the obstacles. If the road's grip is too low for the plan past the obstacles,
/// plans to stop before the first obstacle.
FeasiblePlan AvoidOrStop(const AvoidanceRequest& request, double safe_distance,
                         const FindCurve& find) {
  const InfeasiblePolicy infeasible = request.road.infeasible;
  FeasiblePlan around =
      MakeFeasibleOnRoad(AroundObstacles(request, safe_distance, find).Run(), request, infeasible);
  if (around.ok()) {
    return around;
  }
  const auto none = [&](const Plan&, const Conflict&, double) {
    return ReplacementSearch{std::nullopt, around->reason};
  };
  const Plan stop = AroundObstacles(request, safe_distance, none).Run();
  FeasiblePlan held = MakeFeasibleOnRoad(stop, request, infeasible);
  // Never refuse the stopping plan of a moving car; the car then brakes as well as it can.
  return held.ok() || !request.car ? held
                                   : MakeFeasibleOnRoad(stop, request, InfeasiblePolicy::kAllow);
}

FeasiblePlan PlanAroundWith(const BezierAvoidanceOptions& options,
                            const AvoidanceRequest& request) {
  TRACKBED_CHECK(options.safe_distance >= 0.0 && options.delay >= 0.0 && options.min_speed > 0.0 &&
                     options.max_lateral_acceleration > 0.0 &&
                     options.max_steering_rate_fraction > 0.0 &&
                     options.max_steering_rate_fraction <= 1.0 &&
                     options.comfortable_steering_rate_fraction > 0.0,
                 "safe distance {}, delay {}, minimum speed {}, lateral acceleration {}, share {}",
                 options.safe_distance, options.delay, options.min_speed,
                 options.max_lateral_acceleration, options.max_steering_rate_fraction);
  const auto find = [&](const Plan& plan, const Conflict& conflict, double from) {
    StretchSearch found = FindStretch(request, options, plan, conflict, from);
    if (!found.stretch) {
      return ReplacementSearch{std::nullopt, std::move(found.why)};
    }
    const Stretch stretch = *std::move(found.stretch);
    return ReplacementSearch{
        Replacement{.stations = {stretch.leave, stretch.back},
                    .start = stretch.problem.start.pose,
                    .curve = stretch.repair.curve,
                    .check = stretch.repair.check,
                    .speed = stretch.problem.speed,
                    .passing_side = stretch.passing_side,
                    .tree = stretch.tree.nodes,
                    .notes = {},
                    .diagnostics =
                        [=, &request, &options](const Plan& around, const Stations& curve) {
                          return DiagnosticsOn(stretch, request, options, around, curve);
                        }},
        ""};
  };
  return AvoidOrStop(request, options.safe_distance, find);
}

FeasiblePlan PlanAroundWith(const ListingAvoidanceOptions& options,
                            const AvoidanceRequest& request) {
  TRACKBED_CHECK(options.safe_distance >= 0.0 && options.delay >= 0.0 &&
                     options.inner_width >= 0.0 && options.outer_width >= 0.0,
                 "safe distance {}, delay {}, free widths {} and {}", options.safe_distance,
                 options.delay, options.inner_width, options.outer_width);
  const auto find = [&](const Plan& plan, const Conflict& conflict, double from) {
    return avoidance::FindListingCurve(request, options, plan, conflict, from);
  };
  return MakeFeasibleOnRoad(AroundObstacles(request, options.safe_distance, find).Run(), request,
                            InfeasiblePolicy::kAllow);
}

}  // namespace

const std::vector<AvoiderEntry>& LocalPlanners() {
  static const std::vector<AvoiderEntry> table{
      {"bezier",
       "RRT* and a degree-7 Bezier curve, repaired until feasible (Skackauskas, dissertation)",
       BezierAvoidanceOptions{}, true},
      {"listing",
       "the curve as Skackauskas's dissertation prints it, without checks, for comparison",
       ListingAvoidanceOptions{}, false},
  };
  return table;
}

bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance) {
  for (double s = station; s <= path.length(); s += kPathCheckSpacing) {
    if (Separation(FootprintAt(vehicle, path.At(s).pose), obstacle) < distance) {
      return true;
    }
  }
  return false;
}

FeasiblePlan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options) {
  TRACKBED_CHECK(request.plan.ok(), "a plan with status {}", ToString(request.plan.status));
  return std::visit([&](const auto& own) { return PlanAroundWith(own, request); }, options);
}

}  // namespace trackbed
