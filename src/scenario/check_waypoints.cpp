#include "src/scenario/check_waypoints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

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

/// Largest number of waypoints. A path with steps of curvature takes about 10 ms for each leg.
constexpr std::size_t kMaxWaypoints = 5000;

void CheckNumber(Diagnostics& c) {
  const std::size_t count = c.scenario.mission.waypoints.size();
  if (count > kMaxWaypoints) {
    c.AddError("mission.waypoints",
               fmt::format("{} given; must be at most {}: give a recorded path to plan: {{method: "
                           "path_file}}, or divide the route",
                           count, kMaxWaypoints));
  }
}

/// Limits the length of the route, and thereby the computing time of the planner and the number of
/// rows of plan.csv.
void CheckRouteLength(Diagnostics& c) {
  const std::vector<Vec2>& waypoints = c.scenario.mission.waypoints;
  double length = 0.0;
  double longest = 0.0;
  std::size_t end = 0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const double leg = (waypoints[i] - waypoints[i - 1]).norm();
    length += leg;
    end = leg > longest ? i : end;
    longest = std::max(leg, longest);
  }
  if (length > kMaxPathLength) {
    c.AddError(fmt::format("mission.waypoints[{}]", end),
               fmt::format("the route is {:.7g} m long; must be at most {:.7g} m: the leg to this "
                           "waypoint is {:.7g} m; correct it, or divide the route",
                           length, kMaxPathLength, longest));
  }
}

/// Returns the names of all planners that meet the headings at the waypoints, separated by commas.
std::string PlannersWithHeadings() {
  std::vector<std::string> names;
  for (const PlannerEntry& planner : Planners()) {
    if (planner.has_headings) {
      names.emplace_back(planner.name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Explains why waypoint `i` must not be at the same point as the previous waypoint. Returns an
/// empty text if the car turns at the waypoint from one heading to another.
std::string WhyNotInPlace(const Scenario& scenario, std::size_t i) {
  const MissionSpec& mission = scenario.mission;
  const char* what = "same point as the previous waypoint";
  if (scenario.plan && !PlannerFor(scenario.plan->global).has_headings) {
    return fmt::format(
        "{}; remove it, or use a planner that turns there from one of "
        "mission.headings to the next: {}",
        what, PlannersWithHeadings());
  }
  if (!scenario.plan || mission.headings.size() != mission.waypoints.size()) {
    return fmt::format("{}; remove it, or give mission.headings for a turn there", what);
  }
  const double before =
      i == 1 ? mission.start.yaw.value_or(mission.headings[0]) : mission.headings[i - 1];
  if (AngleDifference(mission.headings[i], before) == 0.0) {
    return fmt::format(
        "{}, and same heading, {:.6g} rad: nothing to drive; remove it, or give it "
        "another heading",
        what, mission.headings[i]);
  }
  return "";
}

/// Reports waypoints at the same point as the previous waypoint, unless the car turns at this
/// point. The second waypoint may be at the same point as the first one if the car starts at
/// another point.
void CheckEqualWaypoints(Diagnostics& c) {
  const MissionSpec& mission = c.scenario.mission;
  if (!c.CouldReadPlan({"method"}) || !c.CouldRead({"mission.headings", "mission.start.yaw"})) {
    return;
  }
  for (std::size_t i = 1; i < mission.waypoints.size(); ++i) {
    const bool starts_elsewhere = i == 1 && (mission.start.x || mission.start.y);
    if (mission.waypoints[i] != mission.waypoints[i - 1] || starts_elsewhere) {
      continue;
    }
    if (std::string why = WhyNotInPlace(c.scenario, i); !why.empty()) {
      c.AddError(fmt::format("mission.waypoints[{}]", i), std::move(why));
    }
  }
}

}  // namespace

void CheckWaypoints(Diagnostics& c) {
  const std::vector<Vec2>& waypoints = c.scenario.mission.waypoints;
  CheckNumber(c);
  CheckRouteLength(c);
  CheckEqualWaypoints(c);
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

}  // namespace trackbed
