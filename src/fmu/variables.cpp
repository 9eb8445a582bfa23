#include "src/fmu/variables.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "trackbed/core/classic_locale.h"
#include "trackbed/core/text_table.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/keys.h"
#include "trackbed/scenario/log_columns.h"

namespace trackbed::fmu {
namespace {

/// Returns whether the numbers below a key of a scenario are parameters. Expectations, the video
/// and the logged states have no influence on an FMU. The control period is no parameter, because
/// modelDescription.xml states it as a constant.
bool IsParameterKey(const std::string& key) {
  static const std::array kOthers{"schema", "expect", "render", "drive.control_period",
                                  "drive.state_period"};
  return std::none_of(kOthers.begin(), kOthers.end(),
                      [&](std::string_view other) { return key == other; });
}

/// Collects the numbers of a scenario as parameters.
class ParameterFinder {
 public:
  explicit ParameterFinder(std::vector<Variable>& found) : found_(found) {}

  /// Adds the numbers in a section of the scenario as parameters. The argument `key` is the dotted
  /// key of the section, with list indices. The argument `listed` is the section's key with N in
  /// place of each list index.
  void AddSection(const YAML::Node& section, const std::string& key, const std::string& listed) {
    const YAML::Node method = section["method"];
    const std::string chosen = method && method.IsScalar() ? method.Scalar() : "";
    for (const auto& entry : section) {
      const std::string name = entry.first.Scalar();
      const std::string inner = key.empty() ? name : key + "." + name;
      const std::string inner_listed = listed.empty() ? name : listed + "." + name;
      if (!IsParameterKey(inner)) {
        continue;
      }
      if (entry.second.IsMap()) {
        AddSection(entry.second, inner, inner_listed);
      } else if (entry.second.IsSequence() && entry.second.size() > 0 && entry.second[0].IsMap()) {
        for (std::size_t i = 0; i < entry.second.size(); ++i) {
          AddSection(entry.second[i], fmt::format("{}[{}]", inner, i), inner_listed + "[N]");
        }
      } else if (const KeyInfo* info = Find(listed, chosen, name)) {
        AddValue(entry.second, inner, *info, info->unit);
      }
    }
  }

 private:
  [[nodiscard]] const KeyInfo* Find(const std::string& section, const std::string& method,
                                    const std::string& name) const {
    for (const KeySection& own : keys_) {
      if (own.key != section || (!own.method.empty() && own.method != method)) {
        continue;
      }
      for (const KeyInfo& info : own.keys) {
        if (info.name == name) {
          return &info;
        }
      }
    }
    return nullptr;
  }

  /// Adds a number, or the numbers in a list of numbers or points, as parameters. The argument
  /// `unit` is the unit of all numbers, or the units of the numbers in each point, as in "s, m/s".
  void AddValue(const YAML::Node& value, const std::string& key, const KeyInfo& info,
                const std::string& unit) {
    if (value.IsSequence()) {
      const std::size_t comma = unit.find(", ");
      const bool has_numbers = value.size() > 0 && value[0].IsScalar();
      for (std::size_t i = 0; i < value.size(); ++i) {
        const bool second = i > 0 && has_numbers && comma != std::string::npos;
        AddValue(value[i], fmt::format("{}[{}]", key, i), info,
                 second        ? unit.substr(comma + 2)
                 : has_numbers ? unit.substr(0, comma)
                               : unit);
      }
      return;
    }
    const bool is_text =
        info.type.find("name") != std::string::npos || info.type.find("true") != std::string::npos;
    const std::optional<double> number =
        value.IsScalar() && !is_text ? CellNumber(value.Scalar()) : std::nullopt;
    if (number) {
      const bool whole = info.type.find("whole") != std::string::npos;
      found_.push_back({.name = key,
                        .type = whole ? Type::kInteger : Type::kReal,
                        .causality = Causality::kParameter,
                        .unit = unit,
                        .text = info.text,
                        .start = *number});
    }
  }

  std::vector<KeySection> keys_ = ScenarioKeys();
  std::vector<Variable>& found_;
};

/// Returns the unit in the name of a column of a log (docs/conventions.md).
std::string UnitOfColumn(const std::string& column) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 8> kUnits{
      {{"_mps2", "m/s^2"},
       {"_radps", "rad/s"},
       {"_radpm", "1/m"},
       {"_mps", "m/s"},
       {"_rad", "rad"},
       {"_N", "N"},
       {"_m", "m"},
       {"_s", "s"}}};
  for (const auto& [ending, unit] : kUnits) {
    if (column.ends_with(ending)) {
      return unit;
    }
  }
  return "";
}

}  // namespace

std::vector<std::string> StatusNames() {
  std::vector<std::string> names{"running"};
  for (int status = 0; status <= static_cast<int>(DriveStatus::kInterrupted); ++status) {
    names.emplace_back(ToString(static_cast<DriveStatus>(status)));
  }
  return names;
}

std::vector<Variable> Variables(const std::string& yaml, const Scenario& scenario) {
  std::vector<Variable> variables{
      {"time", Type::kReal, Causality::kIndependent, "s", "time of the simulation"},
      {"commanded_steering_rad", Type::kReal, Causality::kInput, "rad",
       "commanded steering angle of the bicycle model, positive to the left"},
      {"commanded_acceleration_mps2", Type::kReal, Causality::kInput, "m/s^2",
       "commanded acceleration, positive if the car speeds up in the direction of its gear"},
      {"controller_steers", Type::kBoolean, Causality::kParameter, "",
       "true: the scenario's controller drives, and both commands are ignored"},
      {"plan_sets_speed", Type::kBoolean, Causality::kParameter, "",
       "true: the car follows the speeds of the plan, and the commanded acceleration is ignored"},
      {"status", Type::kStatus, Causality::kOutput, "",
       "how the run ended; running before its end"},
  };
  const ClassicLocale locale;
  ParameterFinder(variables).AddSection(YAML::Load(yaml), "", "");
  for (const std::string& column : LogColumns(scenario, scenario.drive.plants.front())) {
    variables.push_back(
        {.name = column, .unit = UnitOfColumn(column), .text = "column of the log of the run"});
  }
  return variables;
}

}  // namespace trackbed::fmu
