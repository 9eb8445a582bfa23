#include "src/scenario/check_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/scenario/check_waypoints.h"
#include "src/scenario/route_world.h"
#include "src/scenario/start_state.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/track/track.h"

// Checks rules that concern several keys of the mission and the plan. A check is skipped if one of
// its keys could not be read, because the reader has already reported the error of that key. The
// rules for a planner depend on properties in the planner's registry entry (PlannerEntry:
// follows_track, follows_lanes, needs_limits, min_waypoints, ...) and not on the planner's name.
namespace trackbed {
namespace {

constexpr const char* kDetourSection = "plan.replan.detour.";

void AddProblems(Diagnostics& c, const std::string& section, std::vector<OptionProblem> problems) {
  for (OptionProblem& problem : problems) {
    c.AddError(section + problem.key, std::move(problem.message));
  }
}

/// Checks rules that concern several options of the global planner or several options of the detour
/// planner.
void CheckPlanners(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (!plan) {
    return;
  }
  if (const auto check = PlannerFor(plan->global).check) {
    const CouldReadKey could_read = [&](const std::string& key) {
      return c.CouldReadPlan({key.c_str()});
    };
    AddProblems(c, PlannerSection(c.scenario), check(plan->global, could_read));
  }
  if (!plan->replan || !plan->replan->detour) {
    return;
  }
  const PlannerOptions& detour = *plan->replan->detour;
  if (const auto check = PlannerFor(detour).check) {
    const CouldReadKey could_read = [&](const std::string& key) {
      return c.could_read(kDetourSection + key);
    };
    AddProblems(c, kDetourSection, check(detour, could_read));
  }
}

/// Returns what a user can do to get a plan without reverse segments. Detours are forward only, so
/// a planner of detours that may reverse has the key `reverse`.
std::string PlanForwards(const Diagnostics& c) {
  return PlannerFor(c.scenario.plan->global).detour_defaults
             ? fmt::format("set {}: false", c.KeyOfPlan("reverse"))
             : "use a planner that drives forwards only, for example dubins";
}

void CheckAvoider(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (plan && plan->avoid && MayGoBackwards(plan->global) && c.CouldReadPlan({"method"})) {
    c.AddError(
        "plan.avoid",
        fmt::format("not available for plans by {}, which may reverse; remove plan.avoid or {}",
                    PlannerFor(plan->global).name, PlanForwards(c)));
  }
}

/// Rejects a neutral steering angle together with local planners, because local planners plan
/// detours that begin and end with a steering angle of 0.
void CheckNeutralSteering(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (NeutralSteering(c.scenario) == 0.0 || !(plan->avoid || plan->replan) ||
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

void CheckReplan(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  if (!plan || !plan->replan) {
    return;
  }
  const ReplanOptions& replan = *plan->replan;
  if (MayGoBackwards(plan->global) && c.CouldReadPlan({"method"})) {
    c.AddError(
        "plan.replan",
        fmt::format("not available for plans by {}, which may reverse; replanning is forward only; "
                    "remove plan.replan or {}",
                    PlannerFor(plan->global).name, PlanForwards(c)));
  }
  if (!c.CouldRead({"plan.replan.along", "plan.replan.along.method", "plan.replan.detour",
                    "plan.replan.detour.method"})) {
    return;
  }
  if (replan.detour && MayGoBackwards(*replan.detour)) {
    c.AddError("plan.replan.detour.reverse", "not allowed in a detour, which is forward only");
  }
  if (replan.detour) {
    if (const auto check = PlannerFor(*replan.detour).check_detour) {
      AddProblems(c, kDetourSection, check(*replan.detour));
    }
  }
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

void CheckLaps(Diagnostics& c) {
  const auto& track = c.scenario.mission.track;
  if (!track || track->data == nullptr || !c.CouldRead({"mission.track", "mission.track.laps"})) {
    return;
  }
  const double lap = track->data->length();
  if (track->laps * lap > std::max(kMaxPathLength, lap)) {
    c.AddError("mission.track.laps",
               fmt::format("{} laps of {:.6g} m are {:.7g} m; must be at most {:.7g} m, {} laps",
                           track->laps, lap, track->laps * lap, kMaxPathLength,
                           static_cast<int>(kMaxPathLength / lap)));
  }
}

/// Checks the options of the plan's speed profile. A speed profile at the car's limits is computed
/// for a single plan, but local avoidance and replanning change the speeds during the run. A speed
/// profile at the car's limits is therefore rejected if the scenario uses local avoidance or
/// replanning, except for planners that follow a track.
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
  // Smallest friction coefficient; the g-g-v diagram, with a resolution of 0.0006 m/s^2, is too
  // coarse for lower friction.
  constexpr double kMinFriction = 0.01;
  const auto check = [&](const std::string& key, double friction) {
    if (friction < kMinFriction && c.could_read(key)) {
      c.AddError(key, fmt::format("{} is below {}, the least for speeds at the limit", friction,
                                  kMinFriction));
    }
  };
  const World& world = c.scenario.world;
  check("world.friction", world.friction);
  for (std::size_t i = 0; i < world.friction_patches.size(); ++i) {
    check(fmt::format("world.friction_patches[{}].friction", i),
          world.friction_patches[i].friction);
  }
}

/// Checks that a scenario with a track uses a planner that follows a track, and vice versa.
void CheckTrack(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const bool has_track = c.scenario.mission.track.has_value();
  if (!c.CouldReadPlan({"method"}) || !c.could_read("mission.track")) {
    return;
  }
  const char* key = "mission.track";
  if (!plan) {
    if (has_track) {
      c.AddError(key, fmt::format("needs plan: {{method: {}}} or another planner that follows a "
                                  "track",
                                  NameOfPlannerThat(&PlannerEntry::follows_track)));
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

/// Checks that planners which need a speed profile at the car's limits are used with
/// mission.speed_profile: {method: limits}.
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

/// Checks that a scenario with a route over roads uses a planner that follows lanes, and vice
/// versa.
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
      c.AddError("mission.route", fmt::format("needs plan: {{method: {}}}",
                                              NameOfPlannerThat(&PlannerEntry::follows_lanes)));
    }
    return;
  }
  const char* planner = PlannerFor(plan->global).name;
  if (!roads) {
    c.AddError("world.road_network",
               fmt::format("missing; the planner {} follows its lanes", planner));
  }
  if (route.size() < 2) {
    c.AddError("mission.route", fmt::format("{} given; the planner {} needs at least 2",
                                            route.empty() ? "none" : "1", planner));
  }
  if (route.size() > kMaxLanePlaces) {
    c.AddError("mission.route",
               fmt::format("{} places; must be at most {}", route.size(), kMaxLanePlaces));
    return;
  }
  for (std::size_t i = 0; roads && roads->data && i < route.size(); ++i) {
    const std::string key = fmt::format("mission.route[{}]", i);
    if (!c.could_read(key) || !c.could_read(key + ".road") || !c.could_read(key + ".lane") ||
        !c.could_read(key + ".s")) {
      continue;
    }
    if (std::string why = LanePlaceError(roads->data->network, route[i]); !why.empty()) {
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
  CheckLaps(c);
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
}

}  // namespace

void CheckMissionAndPlan(Diagnostics& c) {
  CheckMission(c);
  CheckSpeedProfile(c);
  CheckTrack(c);
  CheckLimits(c);
  CheckLanes(c);
  CheckPlanners(c);
  CheckAvoider(c);
  CheckNeutralSteering(c);
  CheckReplan(c);
}

}  // namespace trackbed
