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

/// Returns the prefix of the global planner's keys in the scenario file, "plan." or "plan.global.".
inline std::string PlannerSection(const Scenario& scenario) {
  const bool layers = scenario.plan->avoid || scenario.plan->replan;
  return layers ? "plan.global." : "plan.";
}

/// Returns the name of the first registered planner that has the property `property`, so that an
/// error message can suggest this planner.
inline const char* NameOfPlannerThat(bool PlannerEntry::*property) {
  const std::vector<PlannerEntry>& planners = Planners();
  return std::find_if(planners.begin(), planners.end(),
                      [&](const PlannerEntry& planner) { return planner.*property; })
      ->name;
}

/// Collects problems that concern several keys of a scenario. Each problem is stored together with
/// the key at which the problem is reported to the user.
struct Diagnostics {
  const Scenario& scenario;
  /// Function that returns whether the value of a key was read. If the value of a key was not read,
  /// the reader has already reported a problem of this key.
  const std::function<bool(const std::string& key)>& could_read;
  std::vector<std::pair<std::string, std::string>> found{};

  [[nodiscard]] bool CouldRead(std::initializer_list<const char*> keys) const {
    return std::all_of(keys.begin(), keys.end(), could_read);
  }

  /// Returns whether the given keys of the global plan were read. A file may contain the keys of
  /// the global plan in the section `plan` or in `plan.global`.
  [[nodiscard]] bool CouldReadPlan(std::initializer_list<const char*> keys) const {
    return could_read("plan.global") &&
           std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
             return could_read("plan." + key) && could_read("plan.global." + key);
           });
  }

  /// Returns the dotted key of an option of the global planner.
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

}  // namespace trackbed
