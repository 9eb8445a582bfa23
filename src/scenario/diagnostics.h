#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Prefix of the keys of the global planner.
inline std::string PlannerSection(const Scenario& scenario) {
  const bool layers = scenario.plan->avoid || scenario.plan->replan;
  return layers ? "plan.global." : "plan.";
}

/// Name of the first planner with this property, for the advice in a message.
inline const char* NameOfPlannerThat(bool PlannerEntry::*property) {
  const std::vector<PlannerEntry>& planners = Planners();
  return std::find_if(planners.begin(), planners.end(),
                      [&](const PlannerEntry& planner) { return planner.*property; })
      ->name;
}

/// Collects problems between keys of a scenario, each with the key to report.
struct Diagnostics {
  const Scenario& scenario;
  /// Whether the value of a key was read. If a key was not read, its problem has already been
  /// reported.
  const std::function<bool(const std::string& key)>& could_read;
  std::vector<std::pair<std::string, std::string>> found{};

  [[nodiscard]] bool CouldRead(std::initializer_list<const char*> keys) const {
    return std::all_of(keys.begin(), keys.end(), could_read);
  }

  /// Same as CouldRead, for keys of the global plan. Keys of the global plan may be given in `plan`
  /// or in `plan.global`.
  [[nodiscard]] bool CouldReadPlan(std::initializer_list<const char*> keys) const {
    return could_read("plan.global") &&
           std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
             return could_read("plan." + key) && could_read("plan.global." + key);
           });
  }

  /// Dotted key of an option of the global planner.
  [[nodiscard]] std::string KeyOfPlan(const char* key) const {
    return PlannerSection(scenario) + key;
  }

  [[nodiscard]] std::string Driven() const {
    return fmt::format("{}", fmt::join(scenario.drive.plants, ", "));
  }

  void AddError(std::string key, std::string message) {
    found.emplace_back(std::move(key), std::move(message));
  }
};

/// Checks the mission and the plan.
void CheckMissionAndPlan(Diagnostics& c);
/// Checks the expectations.
void CheckExpectations(Diagnostics& c);

}  // namespace trackbed
