#pragma once

#include "src/scenario/key_lister.h"
#include "src/scenario/visit_planners.h"
#include "src/scenario/visit_replan.h"
#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/scenario/scenario.h"

/// The keys of `plan`.
namespace trackbed {

/// The layers of a plan, each under its own key.
struct PlanLayers {
  std::optional<PlannerOptions>& global;
  std::optional<AvoiderOptions>& avoid;
  std::optional<ReplanOptions>& replan;
  InfeasiblePolicy& infeasible;
};

inline constexpr Key kPlan{"plan", "", "how the path is made; without it there is none to follow"};
inline constexpr Key kAvoid{"avoid", "", "what leads the path around obstacles that stand in it"};
inline constexpr Key kReplan{"replan", "", "how to plan again while driving"};

template <typename Archive>
void VisitInfeasible(Archive& a, InfeasiblePolicy& policy) {
  static const EnumNames<InfeasiblePolicy> policies{{InfeasiblePolicy::kSlowDown, "slow_down"},
                                                    {InfeasiblePolicy::kRefuse, "refuse"},
                                                    {InfeasiblePolicy::kAllow, "allow"}};
  a.Field({"infeasible", "",
           "what becomes of a plan that asks for more steering, grip or braking than the car has"},
          policy, Need::kOptional, policies);
}

template <typename Archive>
void Visit(Archive& a, PlanLayers& layers) {
  a.Method({"global", "", "the planner of the whole path"}, layers.global, Planners(),
           Need::kRequired, [](auto&) {});
  a.Method(kAvoid, layers.avoid, Avoiders(), Need::kOptional, [](auto&) {});
  a.Section(kReplan, layers.replan);
  VisitInfeasible(a, layers.infeasible);
}

/// `plan: {method: …}` is short for `plan: {global: {method: …}}`.
inline void VisitPlan(YamlReader& a, std::optional<PlanSpec>& plan) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  std::optional<ReplanOptions> replan;
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  if (a.HasOneOf(kPlan.name, {"global", "avoid", "replan"})) {
    PlanLayers layers{global, avoid, replan, infeasible};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional,
             [&](YamlReader& inner) { VisitInfeasible(inner, infeasible); });
  }
  if (global) {
    plan = {*global, avoid, replan, infeasible};
  }
}

inline void VisitPlan(YamlWriter& a, std::optional<PlanSpec>& plan) {
  if (!plan) {
    return;
  }
  std::optional<PlannerOptions> global = plan->global;
  if (plan->avoid || plan->replan) {
    PlanLayers layers{global, plan->avoid, plan->replan, plan->infeasible};
    a.Section(kPlan, layers);
  } else {
    a.Method(kPlan, global, Planners(), Need::kOptional,
             [&](YamlWriter& inner) { VisitInfeasible(inner, plan->infeasible); });
  }
}

inline void VisitPlan(KeyLister& a, std::optional<PlanSpec>&) {
  std::optional<PlannerOptions> global;
  std::optional<AvoiderOptions> avoid;
  std::optional<ReplanOptions> replan = ReplanOptions{};
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  a.Method(kPlan, global, Planners(), Need::kOptional, [&](KeyLister& inner) {
    inner.Add(
        {"global", "", "the keys of this section, when `avoid` or `replan` stands beside them"},
        "section", Need::kOptional, "", "");
    inner.Method(kAvoid, avoid, Avoiders(), Need::kOptional, [](auto&) {});
    inner.Section(kReplan, replan);
    VisitInfeasible(inner, infeasible);
  });
}

}  // namespace trackbed
