#include "src/scenario/check_requirements.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/requirement/formula.h"
#include "trackbed/scenario/log_columns.h"

namespace trackbed {
namespace {

/// Returns whether a requirement's name may be part of the path of a metric.
bool IsMetricWord(const std::string& name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= 100 && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

class RequirementCheck {
 public:
  explicit RequirementCheck(const Scenario& scenario) {
    for (const std::string& plant : scenario.drive.plants) {
      columns_.emplace_back(plant, LogColumns(scenario, plant));
    }
  }

  /// Checks the requirements that apply to one plant; if `plant` is empty, checks the requirements
  /// that apply to all plants.
  void Check(const std::string& key, const PlantExpectation& expect, const std::string& plant) {
    for (std::size_t i = 0; i < expect.requirements.size(); ++i) {
      const RequirementExpectation& requirement = expect.requirements[i];
      const std::string own = fmt::format("{}.requirements[{}]", key, i);
      if (!IsMetricWord(requirement.name)) {
        found_.emplace_back(own + ".name",
                            fmt::format("'{}' must be up to 100 of a-z, 0-9 and '_' and start with "
                                        "a letter",
                                        requirement.name));
      } else if (!names_.emplace(plant, requirement.name).second ||
                 (!plant.empty() && names_.count({"", requirement.name}) > 0)) {
        found_.emplace_back(own + ".name",
                            fmt::format("'{}' is the name of two requirements", requirement.name));
      }
      if (std::string why = FormulaError(requirement.formula, plant); !why.empty()) {
        found_.emplace_back(own + ".formula", std::move(why));
      }
    }
  }

  std::vector<std::pair<std::string, std::string>> Take() { return std::move(found_); }

 private:
  [[nodiscard]] std::string FormulaError(const std::string& text, const std::string& plant) const {
    std::vector<std::string> all;
    for (const auto& [name, columns] : columns_) {
      if (plant.empty() || name == plant) {
        std::copy_if(columns.begin(), columns.end(), std::back_inserter(all),
                     [&](const std::string& column) {
                       return std::find(all.begin(), all.end(), column) == all.end();
                     });
      }
    }
    std::vector<std::string> signals;
    try {
      signals = Formula::Parse(text, all).signals();
    } catch (const InputError& error) {
      const Problem& problem = error.problems().front();
      return fmt::format("column {} of the formula: {}", problem.column, problem.message);
    }
    for (const auto& [name, columns] : columns_) {
      for (const std::string& signal : signals) {
        if ((plant.empty() || name == plant) &&
            std::find(columns.begin(), columns.end(), signal) == columns.end()) {
          return fmt::format(
              "the log of {} has no column {}; give the requirement for a plant "
              "that has it, such as expect.mujoco.requirements",
              name, signal);
        }
      }
    }
    return "";
  }

  // For each plant, the names of the columns in its log.
  std::vector<std::pair<std::string, std::vector<std::string>>> columns_;
  // Names of all requirements checked so far, each paired with the name of the plant.
  std::set<std::pair<std::string, std::string>> names_;
  std::vector<std::pair<std::string, std::string>> found_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> RequirementProblems(const Scenario& scenario) {
  const Expectations& expect = scenario.expect;
  if (expect.all.requirements.empty() &&
      std::all_of(expect.plants.begin(), expect.plants.end(),
                  [](const auto& own) { return own.second.requirements.empty(); })) {
    return {};
  }
  RequirementCheck check(scenario);
  check.Check("expect", expect.all, "");
  for (const auto& [plant, own] : expect.plants) {
    check.Check("expect." + plant, own, plant);
  }
  return check.Take();
}

}  // namespace trackbed
