#include "trackbed/analysis/sweep_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "src/analysis/study_description.h"
#include "trackbed/analysis/bisect.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// Runs the scenario of one row of a study, and adds the outputs of the run to the row.
class RowMaker {
 public:
  RowMaker(const Study& study, const RunScenarioOnce& run) : study_(study), run_(run) {}

  /// Runs one repetition of a point of the study; returns nullopt if the run was interrupted.
  [[nodiscard]] std::optional<SweepRow> Make(const StudyPoint& point,
                                             std::uint64_t repetition) const {
    if (!point.refused.empty()) {
      return WithoutResult(point, repetition, kRefused, point.refused);
    }
    try {
      return study_.bisect ? BisectAt(point, repetition) : RunAt(point, repetition);
    } catch (const InputError& error) {
      return WithoutResult(point, repetition, kRefused, error.problems().front().WithoutPlace());
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      return WithoutResult(point, repetition, kError, error.what());
    }
  }

 private:
  static constexpr const char* kRefused = "refused";
  static constexpr const char* kError = "error";

  [[nodiscard]] SweepRow WithoutResult(const StudyPoint& point, std::uint64_t repetition,
                                       std::string_view status, std::string reason) const {
    const std::uint64_t seed = point.scenario.seed + repetition;
    SweepRow row{.cells = Parameters(point),
                 .refused = status == kRefused,
                 .error = status == kError,
                 .runs = 0,
                 .bisection = {}};
    if (study_.bisect) {
      row.cells.emplace_back();
      row.bisection = {{"point", SettingsJson(point.settings)}, {"seed", seed}, {"status", status}};
    }
    AddSeed(seed, row);
    row.cells.emplace_back(status);
    if (study_.bisect) {
      row.cells.push_back(std::to_string(row.runs));
    }
    AddOutputs({}, row);
    row.cells.push_back(std::move(reason));
    return row;
  }

  [[nodiscard]] std::optional<SweepRow> RunAt(const StudyPoint& point,
                                              std::uint64_t repetition) const {
    Scenario scenario = point.scenario;
    scenario.seed += repetition;
    const std::optional<RunOutcome> outcome = run_(scenario);
    if (!outcome) {
      return std::nullopt;
    }
    SweepRow row{.cells = Parameters(point), .passed = outcome->passed, .bisection = {}};
    AddSeed(scenario.seed, row);
    row.cells.push_back(outcome->status);
    AddOutputs(outcome->outputs, row);
    row.cells.push_back(outcome->reason);
    return row;
  }

  [[nodiscard]] std::optional<SweepRow> BisectAt(const StudyPoint& point,
                                                 std::uint64_t repetition) const {
    const BisectSpec& spec = *study_.bisect;
    Outputs best;  // outputs of the passing run with the largest value of the bisected key
    std::optional<double> lowest_failing;
    std::string failure;  // reason of the failing run with the smallest value of the bisected key
    const Bisection bisection =
        Bisect(spec.from, spec.to, spec.tolerance, [&](double value) -> std::optional<bool> {
          Scenario scenario = ReadPoint(study_, point.settings, value);
          scenario.seed += repetition;
          std::optional<RunOutcome> outcome = run_(scenario);
          if (!outcome) {
            return std::nullopt;
          }
          if (outcome->passed) {
            best = std::move(outcome->outputs);
          } else if (!lowest_failing || value < *lowest_failing) {
            lowest_failing = value;
            failure = outcome->reason;
          }
          return outcome->passed;
        });
    if (bisection.status == BisectStatus::kInterrupted) {
      return std::nullopt;
    }
    const bool has_value = bisection.status != BisectStatus::kFailsAtFrom;
    const std::uint64_t seed = point.scenario.seed + repetition;
    SweepRow row{.cells = Parameters(point),
                 .passed = has_value,
                 .runs = bisection.trials.size(),
                 .bisection = Describe(point, seed, bisection)};
    row.cells.push_back(has_value ? ShortestText(bisection.value) : "");
    AddSeed(seed, row);
    row.cells.emplace_back(ToString(bisection.status));
    row.cells.push_back(std::to_string(row.runs));
    AddOutputs(best, row);
    row.cells.push_back(
        failure.empty() ? "" : fmt::format("at {}: {}", ShortestText(*lowest_failing), failure));
    return row;
  }

  [[nodiscard]] ordered_json Describe(const StudyPoint& point, std::uint64_t seed,
                                      const Bisection& bisection) const {
    ordered_json json{{"point", SettingsJson(point.settings)}, {"seed", seed}};
    json["status"] = ToString(bisection.status);
    if (bisection.status != BisectStatus::kFailsAtFrom) {
      json["value"] = bisection.value;
    }
    for (const Trial& trial : bisection.trials) {
      json["trials"].push_back({{"value", trial.value}, {"passed", trial.passed}});
    }
    return json;
  }

  [[nodiscard]] std::vector<std::string> Parameters(const StudyPoint& point) const {
    std::vector<std::string> cells;
    for (const std::string& key : ParameterKeys(study_)) {
      const auto found = std::find_if(point.settings.begin(), point.settings.end(),
                                      [&](const Setting& setting) { return setting.key == key; });
      cells.push_back(found == point.settings.end() ? "" : CellText(found->value));
    }
    return cells;
  }

  void AddSeed(std::uint64_t seed, SweepRow& row) const {
    if (study_.repeat > 1) {
      row.cells.push_back(std::to_string(seed));
    }
  }

  void AddOutputs(const Outputs& outputs, SweepRow& row) const {
    for (const OutputSpec& output : study_.outputs) {
      const auto found = outputs.find(output.path);
      row.cells.push_back(found == outputs.end() ? "" : found->second);
    }
  }

  const Study& study_;
  const RunScenarioOnce& run_;
};

}  // namespace

ordered_json ToJson(const SweepRow& row) {
  ordered_json json{{"cells", row.cells}, {"runs", row.runs}};
  const std::array<std::pair<const char*, bool>, 3> flags{
      {{"passed", row.passed}, {"refused", row.refused}, {"error", row.error}}};
  for (const auto& [name, is_set] : flags) {
    if (is_set) {
      json[name] = true;
    }
  }
  if (!row.bisection.is_null()) {
    json["bisection"] = row.bisection;
  }
  return json;
}

SweepRow ReadRow(const SweepRecords& records, std::size_t row) {
  const JsonValue json = records.Entry(row);
  const auto flag = [&](const char* name) {
    const std::optional<JsonValue> value = json.Find(name);
    return value && value->Flag();
  };
  const std::optional<JsonValue> bisection = json.Find("bisection");
  SweepRow read{.cells = json.At("cells").Texts(),
                .passed = flag("passed"),
                .refused = flag("refused"),
                .error = flag("error"),
                .runs = json.At("runs").Count(),
                .bisection = bisection ? bisection->json() : ordered_json()};
  if (read.cells.size() != records.Columns().size()) {
    json.At("cells").Refuse(fmt::format("a list of {}", records.Columns().size()));
  }
  return read;
}

std::optional<SweepRow> MakeRow(const Study& study, const RunScenarioOnce& run,
                                const StudyPoint& point, std::uint64_t repetition) {
  return RowMaker(study, run).Make(point, repetition);
}

}  // namespace trackbed
