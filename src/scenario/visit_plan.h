#pragma once

#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/scenario.h"

/// Declares the keys of the section `plan` of a scenario.
namespace trackbed {

/// Layers of a plan; each layer has its own key in the section `plan` of a scenario.
struct PlanLayers {
  std::optional<PlannerOptions>& global;
  std::optional<AvoiderOptions>& avoid;
  std::optional<ReplanOptions>& replan;
  InfeasiblePolicy& infeasible;
};

inline constexpr Key kPlan{"plan", "", "planner; without it there is no path to follow"};
inline constexpr Key kAvoid{"avoid", "",
                            "local planner: reroutes the path around static obstacles"};
inline constexpr Key kReplan{"replan", "", "replanning during the run"};

inline void VisitInfeasible(KeyVisitor& a, InfeasiblePolicy& policy) {
  static const EnumNames<InfeasiblePolicy> policies{{InfeasiblePolicy::kSlowDown, "slow_down"},
                                                    {InfeasiblePolicy::kRefuse, "refuse"},
                                                    {InfeasiblePolicy::kAllow, "allow"}};
  a.Field({"infeasible", "",
           "handling of plans that exceed the car's steering, friction or braking limits"},
          policy, Need::kOptional, policies);
}

inline void Visit(KeyVisitor& a, PlanLayers& layers) {
  a.Method({"global", "", "global planner"}, layers.global, Planners(), Need::kRequired);
  a.Method(kAvoid, layers.avoid, LocalPlanners(), Need::kOptional);
  a.Section(kReplan, layers.replan);
  VisitInfeasible(a, layers.infeasible);
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
  if (avoid || replan || a.HasAny(kPlan.name, {"global", "avoid", "replan"})) {
    PlanLayers layers{global, avoid, replan, infeasible};
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
      VisitInfeasible(inner, infeasible);
    });
  }
  if (global && a.mode() == Mode::kRead) {
    plan = {*global, avoid, replan, infeasible};
  }
}

}  // namespace trackbed
