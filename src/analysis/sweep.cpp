#include "trackbed/analysis/sweep.h"

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "src/analysis/parallel.h"
#include "trackbed/analysis/bisect.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Keys of the parameters in the order of their columns.
std::vector<std::string> ParameterKeys(const Study& study) {
  std::vector<std::string> keys;
  for (const auto& alternatives : study.vary) {
    keys.push_back(alternatives.front().key);
  }
  for (const auto& point : study.list) {
    for (const Setting& setting : point) {
      if (std::find(keys.begin(), keys.end(), setting.key) == keys.end()) {
        keys.push_back(setting.key);
      }
    }
  }
  return keys;
}

std::vector<std::string> Columns(const Study& study) {
  std::vector<std::string> columns = ParameterKeys(study);
  if (study.bisect) {
    columns.push_back(study.bisect->key);
  }
  if (study.repeat > 1) {
    columns.emplace_back("seed");
  }
  columns.emplace_back("status");
  if (study.bisect) {
    columns.emplace_back("runs");
  }
  for (const OutputSpec& output : study.outputs) {
    columns.push_back(output.path);
  }
  columns.emplace_back("reason");
  return columns;
}

/// A value of YAML as one of JSON: numbers and the like as such, all else as text.
ordered_json SettingsJson(const std::string& value) {
  ordered_json json = ordered_json::parse(CellText(value), nullptr, false);
  return json.is_discarded() ? ordered_json(value) : json;
}

ordered_json SettingsJson(const std::vector<Setting>& settings) {
  ordered_json json = ordered_json::object();
  for (const Setting& setting : settings) {
    json[setting.key] = SettingsJson(setting.value);
  }
  return json;
}

/// One row of the table, before it is known which others there are.
struct Row {
  std::vector<std::string> cells;
  bool passed = false;
  bool refused = false;
  bool error = false;
  std::size_t runs = 1;
  ordered_json bisection;
};

/// Makes the rows of a study.
class RowMaker {
 public:
  RowMaker(const Study& study, const RunScenarioOnce& run) : study_(study), run_(run) {}

  /// The row of a point's `repetition`; nothing when it was interrupted.
  [[nodiscard]] std::optional<Row> Make(const StudyPoint& point, std::uint64_t repetition) const {
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

  [[nodiscard]] Row WithoutResult(const StudyPoint& point, std::uint64_t repetition,
                                  std::string_view status, std::string reason) const {
    const std::uint64_t seed = point.scenario.seed + repetition;
    Row row{.cells = Parameters(point),
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

  [[nodiscard]] std::optional<Row> RunAt(const StudyPoint& point, std::uint64_t repetition) const {
    Scenario scenario = point.scenario;
    scenario.seed += repetition;
    const std::optional<RunOutcome> outcome = run_(scenario);
    if (!outcome) {
      return std::nullopt;
    }
    Row row{.cells = Parameters(point), .passed = outcome->passed, .bisection = {}};
    AddSeed(scenario.seed, row);
    row.cells.push_back(outcome->status);
    AddOutputs(outcome->outputs, row);
    row.cells.push_back(outcome->reason);
    return row;
  }

  [[nodiscard]] std::optional<Row> BisectAt(const StudyPoint& point,
                                            std::uint64_t repetition) const {
    const BisectSpec& spec = *study_.bisect;
    Outputs best;  // of the highest value that passed
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
          }
          return outcome->passed;
        });
    if (bisection.status == BisectStatus::kInterrupted) {
      return std::nullopt;
    }
    const bool has_value = bisection.status != BisectStatus::kFailsAtFrom;
    const std::uint64_t seed = point.scenario.seed + repetition;
    Row row{.cells = Parameters(point),
            .passed = has_value,
            .runs = bisection.trials.size(),
            .bisection = Describe(point, seed, bisection)};
    row.cells.push_back(has_value ? ShortestText(bisection.value) : "");
    AddSeed(seed, row);
    row.cells.emplace_back(ToString(bisection.status));
    row.cells.push_back(std::to_string(row.runs));
    AddOutputs(best, row);
    row.cells.emplace_back();
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

  void AddSeed(std::uint64_t seed, Row& row) const {
    if (study_.repeat > 1) {
      row.cells.push_back(std::to_string(seed));
    }
  }

  void AddOutputs(const Outputs& outputs, Row& row) const {
    for (const OutputSpec& output : study_.outputs) {
      const auto found = outputs.find(output.path);
      row.cells.push_back(found == outputs.end() ? "" : found->second);
    }
  }

  const Study& study_;
  const RunScenarioOnce& run_;
};

ordered_json DescribeStudy(const Study& study) {
  ordered_json json{{"study", study.name}, {"scenario", study.scenario.string()}};
  json["set"] = SettingsJson(study.set);
  json["overrides"] = study.overrides;
  json["vary"] = ordered_json::object();
  for (const auto& alternatives : study.vary) {
    for (const Setting& setting : alternatives) {
      json["vary"][setting.key].push_back(SettingsJson(setting.value));
    }
  }
  json["list"] = ordered_json::array();
  for (const auto& point : study.list) {
    json["list"].push_back(SettingsJson(point));
  }
  json["repeat"] = study.repeat;
  if (study.bisect) {
    json["bisect"] = {{"key", study.bisect->key},
                      {"from", study.bisect->from},
                      {"to", study.bisect->to},
                      {"tolerance", study.bisect->tolerance}};
  }
  json["outputs"] = ordered_json::array();
  for (const OutputSpec& output : study.outputs) {
    json["outputs"].push_back(output.path);
  }
  return json;
}

}  // namespace

SweepResult RunSweep(const Study& study, const std::vector<StudyPoint>& points,
                     const RunScenarioOnce& run, const SweepOptions& options) {
  TRACKBED_CHECK(options.jobs > 0, "{} jobs", options.jobs);
  const auto repeat = static_cast<std::size_t>(study.repeat);
  const RunScenarioOnce unless_interrupted = [&](const Scenario& scenario) {
    return options.interrupted && options.interrupted() ? std::nullopt : run(scenario);
  };
  const RowMaker maker(study, unless_interrupted);
  std::vector<std::optional<Row>> rows(points.size() * repeat);
  std::mutex mutex;
  std::size_t finished = 0;
  ForEachIndex(rows.size(), options.jobs, [&](std::size_t i) {
    rows[i] = maker.Make(points[i / repeat], i % repeat);
    if (rows[i] && options.progress) {
      const std::lock_guard lock(mutex);
      options.progress(static_cast<double>(++finished) / static_cast<double>(rows.size()));
    }
    return rows[i].has_value();
  });

  SweepResult sweep{.table = TextTable(Columns(study)),
                    .description = DescribeStudy(study),
                    .rows_expected = rows.size()};
  ordered_json bisections = ordered_json::array();
  for (std::optional<Row>& row : rows) {
    if (!row) {
      continue;
    }
    sweep.table.AddRow(std::move(row->cells));
    sweep.runs += row->runs;
    sweep.passed += row->passed ? 1U : 0U;
    sweep.refused += row->refused ? 1U : 0U;
    sweep.errors += row->error ? 1U : 0U;
    if (study.bisect) {
      bisections.push_back(std::move(row->bisection));
    }
  }
  sweep.description["complete"] = sweep.complete();
  sweep.description["rows"] = sweep.table.rows().size();
  sweep.description["rows_expected"] = sweep.rows_expected;
  sweep.description["runs"] = sweep.runs;
  sweep.description["refused"] = sweep.refused;
  sweep.description["errors"] = sweep.errors;
  if (study.bisect) {
    sweep.description["bisections"] = std::move(bisections);
  }
  sweep.description["versions"] = Versions();
  return sweep;
}

void WriteSweep(const SweepResult& sweep, const OutputFolder& folder) {
  ResultWriter writer(folder);
  writer.Add(run_folder::kSweepCsv, sweep.table.ToCsv());
  writer.Add(run_folder::kSweepJson, sweep.description.dump(2) + "\n");
  writer.Commit(run_folder::kStudy, {run_folder::kReport});
}

}  // namespace trackbed
