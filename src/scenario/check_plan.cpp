#include <limits>

#include "src/scenario/diagnostics.h"
#include "src/scenario/route_world.h"
#include "src/scenario/start_state.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/road_network/open_drive.h"

// Cross-checks of the mission and the plan: rules between keys that the schema of a single key
// cannot express. Each check returns early if one of its keys could not be read, so that an error
// is reported once. Wherever possible, rules depend on the planner's registry entry (PlannerEntry:
// follows_track, follows_lanes, needs_limits, min_waypoints, ...) and not on its name.
namespace trackbed {
namespace {

void CheckCourse(Diagnostics& c) {
  const auto* course = c.scenario.plan ? c.scenario.plan->global.As<CourseOptions>() : nullptr;
  if (course == nullptr) {
    return;
  }
  const std::string key = c.KeyOfPlan("segments");
  if (course->segments.empty() && c.CouldReadPlan({"segments"})) {
    c.AddError(key, "a course needs at least one segment");
  }
  for (std::size_t i = 0; i < course->segments.size(); ++i) {
    const CoursePiece& piece = course->segments[i];
    const std::string own = fmt::format("{}[{}]", key, i);
    if (!c.could_read(own) || !c.could_read(own + ".curvature") ||
        !c.could_read(own + ".curvature_from") || !c.could_read(own + ".curvature_to")) {
      continue;
    }
    if (piece.curvature && (piece.curvature_from || piece.curvature_to)) {
      c.AddError(own, "give curvature or curvature_to, not both");
    } else if (!piece.curvature && !piece.curvature_to) {
      c.AddError(own, "give curvature (0 for a straight), or curvature_to for a ramp");
    }
  }
}

void CheckSmoothing(Diagnostics& c, const PlannerOptions& planner, const std::string& key) {
  const auto* rrt = planner.As<RrtPlannerOptions>();
  if (rrt == nullptr) {
    return;
  }
  const double step = rrt->data_weight + 2.0 * rrt->smoothness_weight;
  if (step <= 0.0 || step >= 1.0) {
    c.AddError(key, fmt::format("data_weight + 2 smoothness_weight is {:.4g}; must be above 0 and "
                                "below 1 for the smoothing to converge",
                                step));
  }
}

void CheckSmoothing(Diagnostics& c) {
  if (!c.scenario.plan) {
    return;
  }
  if (c.CouldReadPlan({"data_weight", "smoothness_weight"})) {
    CheckSmoothing(c, c.scenario.plan->global, c.KeyOfPlan("smoothness_weight"));
  }
  const std::string detour = "plan.replan.detour.";
  if (c.scenario.plan->replan && c.scenario.plan->replan->detour &&
      c.CouldRead({"plan.replan.detour.data_weight", "plan.replan.detour.smoothness_weight"})) {
    CheckSmoothing(c, *c.scenario.plan->replan->detour, detour + "smoothness_weight");
  }
}

void CheckAvoider(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (plan && plan->avoid && MayGoBackwards(plan->global) && c.CouldReadPlan({"method"})) {
    c.AddError("plan.avoid", fmt::format("not available for plans by {}, which may reverse; remove "
                                         "plan.avoid or use another planner",
                                         PlannerFor(plan->global).name));
  }
}

/// Local planners connect to straight legs with straight wheels, so a neutral steering angle is
/// rejected.
void CheckNeutralSteering(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const auto* fillets = plan ? plan->global.As<FilletOptions>() : nullptr;
  if (fillets == nullptr || fillets->neutral_steering == 0.0 || !(plan->avoid || plan->replan) ||
      !c.CouldReadPlan({"neutral_steering"})) {
    return;
  }
  c.AddError(
      c.KeyOfPlan("neutral_steering"),
      fmt::format(
          "not supported together with {}, which needs straight wheels between turns; remove one",
          plan->avoid ? "plan.avoid" : "plan.replan"));
}

void CheckNotEmpty(Diagnostics& c, const std::string& key, const std::vector<double>& values) {
  const std::string dotted = "plan.replan.along." + key;
  if (values.empty() && c.could_read(dotted)) {
    c.AddError(dotted, "must not be empty");
  }
}

/// Detours must be repeatable, so a wall-clock limit is rejected, and must return to the route, so
/// a partial plan is rejected.
void CheckDetourTrees(Diagnostics& c) {
  const auto& detour = c.scenario.plan->replan->detour;
  const auto* rrt = detour ? detour->As<RrtPlannerOptions>() : nullptr;
  if (rrt == nullptr) {
    return;
  }
  if (rrt->time_limit) {
    c.AddError("plan.replan.detour.time_limit",
               "not allowed in a detour, whose planning must be repeatable; use iterations");
  }
  if (rrt->partial.value_or(false)) {
    c.AddError("plan.replan.detour.partial",
               "not allowed in a detour, which must return to the route");
  }
}

void CheckReplan(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (!plan || !plan->replan) {
    return;
  }
  const ReplanOptions& replan = *plan->replan;
  if (MayGoBackwards(plan->global) && c.CouldReadPlan({"method"})) {
    c.AddError(
        "plan.replan",
        fmt::format("not available for plans by {}, which may reverse; replanning is forward only",
                    PlannerFor(plan->global).name));
  }
  if (!c.CouldRead({"plan.replan.along", "plan.replan.along.method", "plan.replan.detour",
                    "plan.replan.detour.method"})) {
    return;
  }
  if (replan.detour && MayGoBackwards(*replan.detour)) {
    c.AddError("plan.replan.detour.reverse", "not allowed in a detour, which is forward only");
  }
  CheckDetourTrees(c);
  if (!replan.along && !replan.detour) {
    c.AddError("plan.replan", "give along, detour or both");
  }
  if (!replan.detour && replan.comparator) {
    c.AddError("plan.replan.comparator", "needs plan.replan.detour");
  }
  if (replan.detour &&
      c.CouldRead({"plan.replan.safe_distance", "plan.replan.detour.safe_distance"})) {
    const std::optional<double> own = PlannerSafeDistance(*replan.detour);
    if (own && *own < replan.settings.safe_distance) {
      c.AddError("plan.replan.detour.safe_distance",
                 fmt::format("{:.4g} m is below plan.replan.safe_distance, {:.4g} m; every detour "
                             "would be blocked",
                             *own, replan.settings.safe_distance));
    }
  }
  if (const auto* lists = replan.along ? std::get_if<FrenetOptions>(&*replan.along) : nullptr) {
    CheckNotEmpty(c, "end_times", lists->end_times);
    CheckNotEmpty(c, "end_offsets", lists->end_offsets);
    CheckNotEmpty(c, "speed_factors", lists->speed_factors);
    CheckNotEmpty(c, "station_offsets", lists->station_offsets);
  } else if (const auto* own =
                 replan.along ? std::get_if<LatticeOptions>(&*replan.along) : nullptr) {
    CheckNotEmpty(c, "end_offsets", own->end_offsets);
    CheckNotEmpty(c, "speed_factors", own->speed_factors);
  }
}

void CheckHeadings(Diagnostics& c) {
  const MissionSpec& mission = c.scenario.mission;
  if (mission.headings.empty() || !c.CouldRead({"mission.headings"})) {
    return;
  }
  if (mission.headings.size() != mission.waypoints.size()) {
    c.AddError("mission.headings",
               fmt::format("{} given for {} waypoints; must be one per waypoint",
                           mission.headings.size(), mission.waypoints.size()));
  }
  if (c.scenario.plan && !PlannerFor(c.scenario.plan->global).has_headings &&
      c.CouldReadPlan({"method"})) {
    c.AddError("mission.headings", fmt::format("the planner {} does not use headings; remove them",
                                               PlannerFor(c.scenario.plan->global).name));
  }
}

void CheckWaypoints(Diagnostics& c) {
  const std::vector<Vec2>& waypoints = c.scenario.mission.waypoints;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if (waypoints[i] == waypoints[i - 1]) {
      c.AddError(fmt::format("mission.waypoints[{}]", i), "same point as the previous waypoint");
    }
  }
  if (c.scenario.plan && PlannerFor(c.scenario.plan->global).min_waypoints == 0 &&
      !waypoints.empty() && c.CouldReadPlan({"method"})) {
    c.AddError("mission.waypoints",
               fmt::format("the planner {} defines its own course; remove them",
                           PlannerFor(c.scenario.plan->global).name));
  }
  CheckHeadings(c);
  if (c.scenario.plan && waypoints.size() < PlannerFor(c.scenario.plan->global).min_waypoints) {
    const std::string given = waypoints.empty() ? "none" : std::to_string(waypoints.size());
    c.AddError("mission.waypoints", fmt::format("{} given; the planner {} needs at least {}", given,
                                                PlannerFor(c.scenario.plan->global).name,
                                                PlannerFor(c.scenario.plan->global).min_waypoints));
  }
}

/// Profiles at the limit apply to a single plan. Local avoidance and replanning change speeds
/// during the run, so they are rejected, except for planners that follow a track.
void CheckSpeedProfile(Diagnostics& c) {
  const auto& profile = c.scenario.mission.speed_profile;
  if (!profile || !c.CouldRead({"mission.speed_profile", "mission.speed_profile.method"}) ||
      !c.CouldReadPlan({"method"})) {
    return;
  }
  const auto& plan = c.scenario.plan;
  if (!plan) {
    c.AddError("mission.speed_profile", "needs a plan; remove it, or give a plan");
  } else if (std::holds_alternative<LimitProfileOptions>(*profile) &&
             (plan->avoid || plan->replan) && !PlannerFor(plan->global).follows_track) {
    c.AddError("mission.speed_profile.method",
               fmt::format("limits is not supported together with {}, which plans other speeds "
                           "during the run; remove one",
                           plan->avoid ? "plan.avoid" : "plan.replan"));
  }
  if (!std::holds_alternative<LimitProfileOptions>(*profile)) {
    return;
  }
  constexpr double kLeastFriction = 0.01;  // the ggv diagram resolves 0.0006 m/s^2
  const auto check = [&](const std::string& key, double friction) {
    if (friction < kLeastFriction && c.could_read(key)) {
      c.AddError(key, fmt::format("{} is below {}, the least for speeds at the limit", friction,
                                  kLeastFriction));
    }
  };
  const World& world = c.scenario.world;
  check("world.friction", world.friction);
  for (std::size_t i = 0; i < world.friction_patches.size(); ++i) {
    check(fmt::format("world.friction_patches[{}].friction", i),
          world.friction_patches[i].friction);
  }
}

/// A track needs a planner that follows one, and vice versa.
void CheckTrack(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const bool has_track = c.scenario.mission.track.has_value();
  if (!c.CouldReadPlan({"method"}) || !c.could_read("mission.track")) {
    return;
  }
  const char* key = "mission.track";
  if (!plan) {
    if (has_track) {
      c.AddError(key, "needs plan: {method: center_line} or another planner that follows a track");
    }
    return;
  }
  const PlannerEntry& planner = PlannerFor(plan->global);
  if (has_track && !planner.follows_track) {
    c.AddError(key, fmt::format("the planner {} does not follow a track; remove it", planner.name));
  } else if (!has_track && planner.follows_track) {
    c.AddError(key, fmt::format("missing; the planner {} follows a track", planner.name));
  }
  if (!planner.follows_track) {
    return;
  }
  if (plan->avoid) {
    c.AddError("plan.avoid",
               "not available on a track, whose edges it does not know; use plan.replan.along");
  }
  if (plan->replan && plan->replan->detour && c.could_read("plan.replan.detour")) {
    c.AddError(
        "plan.replan.detour",
        "not available on a track: it leaves and returns on straights, and does not know the "
        "edges; use plan.replan.along");
  }
}

/// Planners that need a profile at the limit require mission.speed_profile: {method: limits}.
void CheckLimits(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const auto& profile = c.scenario.mission.speed_profile;
  const char* key = "mission.speed_profile";
  if (!plan || !c.CouldReadPlan({"method"}) ||
      !c.CouldRead({"mission.speed_profile", "mission.speed_profile.method"}) ||
      !PlannerFor(plan->global).needs_limits) {
    return;
  }
  if (!profile || !std::holds_alternative<LimitProfileOptions>(*profile)) {
    c.AddError(key, fmt::format("{}the planner {} needs {{method: limits}}",
                                profile ? "" : "missing; ", PlannerFor(plan->global).name));
  }
}

/// A route over roads needs the planner that follows lanes, and vice versa.
void CheckLanes(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const std::vector<LanePlace>& route = c.scenario.mission.route;
  const auto& roads = c.scenario.world.road_network;
  if (!c.CouldReadPlan({"method"}) || !c.CouldRead({"mission.route", "world.road_network"})) {
    return;
  }
  const bool follows = plan && PlannerFor(plan->global).follows_lanes;
  if (!follows) {
    if (!route.empty()) {
      c.AddError("mission.route", "needs plan: {method: lane_route}");
    }
    return;
  }
  if (!roads) {
    c.AddError("world.road_network", "missing; the planner lane_route follows its lanes");
  }
  if (route.size() < 2) {
    c.AddError("mission.route", fmt::format("{} given; the planner lane_route needs at least 2",
                                            route.empty() ? "none" : "1"));
  }
  if (route.size() > kMostLanePlaces) {
    c.AddError("mission.route",
               fmt::format("{} places; must be at most {}", route.size(), kMostLanePlaces));
    return;
  }
  for (std::size_t i = 0; roads && roads->data && i < route.size(); ++i) {
    const std::string key = fmt::format("mission.route[{}]", i);
    if (!c.could_read(key) || !c.could_read(key + ".road") || !c.could_read(key + ".lane") ||
        !c.could_read(key + ".s")) {
      continue;
    }
    if (std::string why = WhyNoPlace(roads->data->network, route[i]); !why.empty()) {
      c.AddError(key, std::move(why));
    }
  }
}

void CheckMission(Diagnostics& c) {
  const MissionSpec& mission = c.scenario.mission;
  const auto& plan = c.scenario.plan;
  if (c.CouldRead({"mission.waypoints"})) {
    CheckWaypoints(c);
  }
  if (!c.CouldReadPlan({"method"})) {
    return;
  }
  const bool has_start_speed = StartSpeedBesideMission(c.scenario) ||
                               !c.CouldRead({"mission.start.speed", "control.speed.over_time",
                                             "control.file", "control.columns", "record"});
  if (mission.speed == 0.0 && c.CouldRead({"mission.speed"}) && (plan || !has_start_speed)) {
    c.AddError("mission.speed", "missing");
  }
  if (c.CouldRead({"control.method"})) {
    const ControllerEntry& controller = ControllerFor(c.scenario.control.steering);
    if (controller.needs_plan && !plan) {
      c.AddError("plan", fmt::format("missing; the controller {} needs a plan", controller.name));
    }
  }
  if (plan && mission.duration) {
    c.AddError("mission.duration", "not allowed with a plan, which ends at the goal; remove one");
  }
  if (!plan && !RunDuration(c.scenario) &&
      c.CouldRead(
          {"mission.duration", "control.file", "control.columns", "record", "record.file"})) {
    c.AddError("mission.duration", "missing; required without a plan");
  }
  const auto* fillet = plan ? plan->global.As<FilletOptions>() : nullptr;
  if (fillet != nullptr && c.CouldReadPlan({"radius", "constraint"}) && !fillet->radius &&
      fillet->constraint == RadiusConstraint::kNone) {
    c.AddError(c.KeyOfPlan("constraint"), "'none' requires plan.radius");
  }
}

}  // namespace

void CheckMissionAndPlan(Diagnostics& c) {
  CheckMission(c);
  CheckSpeedProfile(c);
  CheckTrack(c);
  CheckLimits(c);
  CheckLanes(c);
  CheckCourse(c);
  CheckSmoothing(c);
  CheckAvoider(c);
  CheckNeutralSteering(c);
  CheckReplan(c);
}

}  // namespace trackbed
