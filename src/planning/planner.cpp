#include "trackbed/planning/planner.h"

#include <fmt/format.h>

#include <cmath>

#include "src/planning/fillet_layout.h"
#include "src/planning/route_planners.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/feasibility.h"

namespace trackbed {
namespace {

using nlohmann::json;

json Point(const Vec2& p) {
  return json::array({p.x(), p.y()});
}

/// A search whose every `stride`-th variable is a radius.
json ToJson(const SearchOptions& options, const SearchResult& result, std::size_t stride) {
  json out{{"method", SearchFor(options.method).name},
           {"status", ToString(result.status)},
           {"evaluations", result.evaluations},
           {"objective", result.value},
           {"history", json::array()}};
  for (const SearchProgress& progress : result.history) {
    json radii = json::array();
    for (std::size_t i = 0; i + stride <= progress.x.size(); i += stride) {
      radii.push_back(progress.x[i]);
    }
    out["history"].push_back({{"evaluations", progress.evaluations},
                              {"objective", progress.value},
                              {"radius_m", radii}});
  }
  return out;
}

json ToJson(const FilletOptions& options, const TurnSearch& search) {
  json out = ToJson(options.search, search.result, 1);
  out["first_radius_m"] = search.first_radius;
  out["window_time_s"] = search.time;
  out["window_heading_rad"] = search.heading;
  // JSON knows no infinity: a car that did not turn in its window has no such radius.
  out["free_radius_m"] =
      std::isfinite(search.free_radius) ? json(search.free_radius) : json(nullptr);
  return out;
}

json ToJson(const FilletOptions& options, const FilletTurn& turn) {
  json out{{"waypoint", turn.waypoint},
           {"heading_change_rad", turn.heading_change},
           {"interior_angle_rad", turn.interior_angle},
           {"radius_m", turn.radius},
           {"speed_mps", turn.speed},
           {"active_constraint", ToString(turn.active)},
           {"centre_m", Point(turn.centre)},
           {"arc_start_m", Point(turn.arc_start)},
           {"arc_end_m", Point(turn.arc_end)},
           {"arc_start_s_m", turn.arc_start_s},
           {"arc_length_m", turn.arc_length},
           {"tangent_length_m", turn.tangent_length},
           {"steering_rad", turn.steering},
           {"ramp_time_s", turn.ramp_time},
           {"ramp_distance_m", turn.ramp_distance},
           {"steer_start_m", turn.steer_start},
           {"steer_return_m", turn.steer_return},
           {"ramp_truncated", turn.ramp_truncated}};
  if (!turn.note.empty()) {
    out["note"] = turn.note;
  }
  if (turn.search) {
    out["search"] = ToJson(options, *turn.search);
  }
  return out;
}

/// Where the wheels of a turn are straight again.
double ReturnEnd(const FilletTurn& turn) {
  return turn.steer_return + turn.ramp_distance;
}

std::vector<LoneTurn> LoneTurnsOf(const FilletPlan& plan) {
  std::vector<LoneTurn> lone;
  double straight_from = 0.0;
  for (const FilletTurn& turn : plan.turns) {
    const bool alone = turn.steer_start >= straight_from && turn.neutral == 0.0;
    straight_from = ReturnEnd(turn);
    const double middle = turn.arc_start_s + 0.5 * turn.arc_length;
    if (alone && !turn.ramp_truncated && turn.steer_start + turn.ramp_distance <= middle) {
      lone.push_back({turn.waypoint, turn.steer_start, middle, turn.steering, turn.speed});
    }
  }
  return lone;
}

/// A turn is slow from where its wheels begin to turn to where they are straight again.
std::vector<SpeedCap> CapsOf(const FilletPlan& plan, double speed) {
  std::vector<SpeedCap> caps;
  for (const FilletTurn& turn : plan.turns) {
    if (turn.speed < speed) {
      caps.push_back({turn.steer_start, ReturnEnd(turn), turn.speed});
    }
  }
  return caps;
}

Plan PlanWith(const FilletOptions& options, const PlanRequest& request) {
  const FilletPlan fillets =
      PlanFillets(request.vehicle, request.waypoints, request.speed.speed, options, request.seed);
  Plan plan;
  plan.status = fillets.status;
  plan.reason = fillets.reason;
  if (!plan.ok()) {
    plan.diagnostics["waypoint"] = fillets.waypoint;
    return plan;
  }
  plan.reference.path = fillets.path;
  plan.schedule = fillets.schedule;
  plan.turns = LoneTurnsOf(fillets);
  plan.caps = CapsOf(fillets, request.speed.speed);
  plan.goal = fillets.path.At(fillets.path.length()).pose;
  plan.reference.speed =
      StopAtEnd(fillets.path.length(), request.start_speed, request.speed, plan.caps);
  plan.schedule_speed =
      StopAtEnd(fillets.stop_distance, request.start_speed, request.speed, plan.caps);

  json& out = plan.diagnostics;
  if (options.neutral_steering != 0.0) {
    out["neutral_steering_rad"] = options.neutral_steering;
    out["neutral_curvature_radpm"] =
        CurvatureForSteering(request.vehicle, options.neutral_steering);
  }
  out["turns"] = json::array();
  for (const FilletTurn& turn : fillets.turns) {
    out["turns"].push_back(ToJson(options, turn));
  }
  for (const LoneTurn& turn : plan.turns) {
    const TurnError error = PredictTurn(request.vehicle, fillets.path, turn, 0.0);
    for (json& entry : out["turns"]) {
      if (entry["waypoint"] == turn.waypoint) {
        entry["predicted"] = {{"heading_deficit_rad", error.heading_deficit},
                              {"lateral_offset_m", error.lateral_offset}};
      }
    }
  }
  out["stop_distance_m"] = fillets.stop_distance;
  out["open_loop"] = ToJson(fillets.verification);
  if (fillets.search) {
    out["search"] = ToJson(options.search, *fillets.search, fillet::kDrivenVariables);
  }
  return plan;
}

Plan PlanWith(const LaneChangePlannerOptions& options, const PlanRequest& request) {
  const Pose2& start = request.start;
  const Vec2 first = ToWorld(start, Vec2(options.lead_in, 0.0));
  Plan plan;
  plan.gates = LaneChangeGates(options.standard, options.first, request.vehicle.width,
                               {first.x(), first.y(), start.yaw});
  const double speed = request.speed.speed;
  const double stop = 0.5 * speed * speed / request.speed.deceleration;
  const std::vector<Segment> segments = LaneChangePath(options, plan.gates, start, stop);
  for (const Segment& segment : segments) {
    const double steering = std::abs(SteeringForCurvature(request.vehicle, segment.curvature));
    if (steering > request.vehicle.steering_limit) {
      plan.gates.clear();
      plan.status = PlanStatus::kTurnTooTight;
      plan.reason = fmt::format(
          "between the gates the car would have to steer {:.3f} rad; it can steer {:.3f} rad",
          steering, request.vehicle.steering_limit);
      return plan;
    }
  }
  plan.reference.path = Path(start, segments);
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtEnd(path.length(), request.start_speed, request.speed);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;

  constexpr double kSpacing = 0.5;  // [m]
  std::vector<SteeringSchedule::Knot> knots;
  std::vector<Pose2> poses;
  for (const PathPoint& point : path.Sample(kSpacing)) {
    knots.push_back({point.s, SteeringForCurvature(request.vehicle, point.curvature)});
    poses.push_back(point.pose);
  }
  plan.schedule = SteeringSchedule::Through(std::move(knots));

  json& out = plan.diagnostics;
  out["turns"] = json::array();
  out["gates"] = json::array();
  const std::vector<double> margins = GateMargins(plan.gates, request.vehicle, poses);
  for (std::size_t i = 0; i < plan.gates.size(); ++i) {
    const OrientedBox& lane = plan.gates[i].lane;
    json cones = json::array();
    for (const Vec2& cone : ConesOf(plan.gates[i])) {
      cones.push_back(Point(cone));
    }
    out["gates"].push_back({{"section", plan.gates[i].section},
                            {"cones_m", cones},
                            {"length_m", lane.length},
                            {"width_m", lane.width},
                            {"planned_margin_m", margins[i]}});
  }
  return plan;
}

Plan PlanWith(const CourseOptions& options, const PlanRequest& request) {
  const std::vector<Segment> segments = CourseSegments(options);
  Plan plan;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double sharpest = SharpestCurvature(segments[i]);
    const double steering = std::abs(SteeringForCurvature(request.vehicle, sharpest));
    if (steering > request.vehicle.steering_limit) {
      plan.status = PlanStatus::kTurnTooTight;
      plan.reason = fmt::format(
          "segments[{}] has a curvature of {:.4g} 1/m, which takes {:.3f} rad of steering; the car "
          "can steer {:.3f} rad",
          i, sharpest, steering, request.vehicle.steering_limit);
      plan.diagnostics["segment"] = i;
      return plan;
    }
  }
  plan.reference.path = Path(request.start, segments);
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtEnd(path.length(), request.start_speed, request.speed);
  plan.schedule = CourseSchedule(request.vehicle, segments, request.speed.speed);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;

  json& out = plan.diagnostics;
  out["turns"] = json::array();
  out["segments"] = json::array();
  double start = 0.0;
  for (const Segment& segment : segments) {
    const double speed = request.speed.speed;
    out["segments"].push_back(
        {{"start_s_m", start},
         {"length_m", segment.length},
         {"curvature_from_radpm", segment.curvature},
         {"curvature_to_radpm", segment.CurvatureAt(segment.length)},
         {"lateral_acceleration_mps2", SharpestCurvature(segment) * speed * speed}});
    start += segment.length;
  }
  return plan;
}

}  // namespace

const std::vector<PlannerEntry>& Planners() {
  static const std::vector<PlannerEntry> table{
      {"fillet", "straight legs and arcs of the largest radius the steering rate allows (C.1-C.40)",
       FilletOptions{}, kFewestFilletWaypoints},
      {"lane_change", "through the gates of a double lane change (ISO 3888)",
       LaneChangePlannerOptions{}, 0},
      {"course", "straights, arcs and curvature ramps, piece by piece as given", CourseOptions{},
       0},
      {.name = "dubins",
       .summary = "the shortest curve through the waypoints with headings, forwards",
       .defaults = DubinsOptions{},
       .fewest_waypoints = 2,
       .keeps_clear = true,
       .has_headings = true},
      {.name = "reeds_shepp",
       .summary = "the shortest curve through the waypoints with headings, either way",
       .defaults = ReedsSheppOptions{},
       .fewest_waypoints = 2,
       .keeps_clear = true,
       .has_headings = true,
       .goes_backwards = true},
      {.name = "astar",
       .summary = "around obstacles on a grid, corners rounded or refused (Hart et al. 1968)",
       .defaults = AStarOptions{},
       .fewest_waypoints = 2,
       .keeps_clear = true,
       .searches = true,
       .has_ties = true},
      {.name = "hybrid_astar",
       .summary = "around obstacles through poses that the car can drive, either way",
       .defaults = HybridAStarOptions{},
       .fewest_waypoints = 2,
       .keeps_clear = true,
       .has_headings = true,
       .goes_backwards = true,
       .searches = true},
      {.name = "rrt",
       .summary = "around obstacles along random trees (LaValle 1998), smoothed in the wind",
       .defaults = RrtPlannerOptions{},
       .fewest_waypoints = 2,
       .keeps_clear = true,
       .searches = true,
       .is_random = true},
  };
  return table;
}

const PlannerEntry& PlannerFor(const PlannerOptions& options) {
  for (const PlannerEntry& entry : Planners()) {
    if (entry.defaults.index() == options.index()) {
      return entry;
    }
  }
  throw InternalError("options of a planner that is not in the table");
}

const char* PlannerName(const PlannerOptions& options) {
  return PlannerFor(options).name;
}

bool MayGoBackwards(const PlannerOptions& options) {
  const auto* hybrid = std::get_if<HybridAStarOptions>(&options);
  return PlannerFor(options).goes_backwards && (hybrid == nullptr || hybrid->reverse);
}

bool MayBePartial(const PlannerOptions& options) {
  const auto* rrt = std::get_if<RrtPlannerOptions>(&options);
  return rrt != nullptr && rrt->partial.value_or(rrt->time_limit.has_value());
}

std::size_t FewestWaypoints(const PlannerOptions& options) {
  return PlannerFor(options).fewest_waypoints;
}

Plan MakePlan(const PlanRequest& request, const PlannerOptions& options) {
  const SpeedLimits& speed = request.speed;
  TRACKBED_CHECK(std::isfinite(request.start_speed) && std::isfinite(speed.speed) &&
                     std::isfinite(request.start_steering) && std::isfinite(speed.acceleration) &&
                     std::isfinite(speed.deceleration) && speed.speed > 0.0 &&
                     speed.acceleration > 0.0 && speed.deceleration > 0.0,
                 "start speed {}, speed {}, acceleration {}, deceleration {}", request.start_speed,
                 speed.speed, speed.acceleration, speed.deceleration);
  const Pose2& start = request.start;
  TRACKBED_CHECK(std::isfinite(start.x) && std::isfinite(start.y) && std::isfinite(start.yaw),
                 "start at {}, {}, {}", start.x, start.y, start.yaw);
  for (const Vec2& point : request.waypoints) {
    TRACKBED_CHECK(point.allFinite(), "waypoint {}, {}", point.x(), point.y());
  }
  TRACKBED_CHECK(request.headings.empty() || request.headings.size() == request.waypoints.size(),
                 "{} headings for {} waypoints", request.headings.size(), request.waypoints.size());
  for (const double heading : request.headings) {
    TRACKBED_CHECK(std::isfinite(heading), "heading {}", heading);
  }
  Plan plan = std::visit([&](const auto& own) { return PlanWith(own, request); }, options);
  plan = MakeFeasible(std::move(plan), request);
  if (plan.ok() && !plan.diagnostics.contains("open_loop")) {
    plan.diagnostics["open_loop"] = ToJson(DriveOpenLoop(
        request.vehicle, plan.reference.path, plan.schedule, plan.schedule_speed.knots().back().s));
  }
  return plan;
}

}  // namespace trackbed
