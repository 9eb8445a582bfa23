#pragma once

#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/scenario.h"

/// Declares the keys of the section `plan` of a scenario.
namespace trackbed {

/// Layers of planning (global planner, local avoidance, replanning); each layer has its own key in
/// the section `plan` of a scenario.
struct PlanLayers {
  std::optional<PlannerOptions>& global;
  std::optional<AvoiderOptions>& avoid;
  std::optional<ReplanOptions>& replan;
  InfeasiblePolicy& infeasible;
  std::optional<double>& max_waypoint_miss;
};

inline constexpr Key kPlan{"plan", "",
                           "planner; without it there is no path to follow. Default distances "
                           "from obstacles, cells, margins and costs in meters are those of cars "
                           "with a length of 4 m or more; for smaller cars they are in "
                           "proportion to the length"};
inline constexpr Key kAvoid{"avoid", "",
                            "local planner: reroutes the path around static obstacles"};
inline constexpr Key kReplan{"replan", "", "replanning during the run"};

/// Visits the keys that apply to the plans of all planners.
inline void VisitPlanRules(KeyVisitor& a, InfeasiblePolicy& policy,
                           std::optional<double>& max_waypoint_miss) {
  static const EnumNames<InfeasiblePolicy> policies{{InfeasiblePolicy::kSlowDown, "slow_down"},
                                                    {InfeasiblePolicy::kRefuse, "refuse"},
                                                    {InfeasiblePolicy::kAllow, "allow"}};
  a.Field({"infeasible", "",
           "handling of plans that exceed the car's steering, friction or braking limits"},
          policy, Need::kOptional, policies);
  a.Field({"max_waypoint_miss", "m",
           "maximum distance of the planned path from each waypoint; default: the car's length for "
           "planners that search a polyline and round its corners, otherwise no bound"},
          max_waypoint_miss, kNonNegative);
}

inline void Visit(KeyVisitor& a, PlanLayers& layers) {
  a.Method({"global", "", "global planner"}, layers.global, Planners(), Need::kRequired);
  a.Method(kAvoid, layers.avoid, LocalPlanners(), Need::kOptional);
  a.Section(kReplan, layers.replan);
  VisitPlanRules(a, layers.infeasible, layers.max_waypoint_miss);
}

/// Visits the section `plan`. A scenario may write `plan: {method: …}` as a short form of `plan:
/// {global: {method: …}}`.
inline void VisitPlan(KeyVisitor& a, std::optional<PlanSpec>& plan) {
  using Mode = KeyVisitor::Mode;
  if (a.mode() == Mode::kWrite && !plan) {
    return;
  }
  const PlanSpec given = plan.value_or(PlanSpec{});
  std::optional<PlannerOptions> global;
  if (plan) {
    global = given.global;
  }
  std::optional<AvoiderOptions> avoid = given.avoid;
  std::optional<ReplanOptions> replan = given.replan;
  InfeasiblePolicy infeasible = given.infeasible;
  std::optional<double> max_waypoint_miss = given.max_waypoint_miss;
  if (avoid || replan || a.HasAny(kPlan.name, {"global", "avoid", "replan"})) {
    PlanLayers layers{global, avoid, replan, infeasible, max_waypoint_miss};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional, [&](KeyVisitor& inner) {
      if (inner.mode() == Mode::kList) {
        inner.Mention(
            {"global", "", "keys of the global planner, when `avoid` or `replan` is given"},
            "section");
        inner.Method(kAvoid, avoid, LocalPlanners(), Need::kOptional);
        inner.Section(kReplan, replan);
      }
      VisitPlanRules(inner, infeasible, max_waypoint_miss);
    });
  }
  if (global && a.mode() != Mode::kList) {
    plan = {*global, avoid, replan, infeasible, max_waypoint_miss};
  }
}

}  // namespace trackbed
