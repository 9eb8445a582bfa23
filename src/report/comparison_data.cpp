#include "src/report/comparison_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/report/checks.h"
#include "src/report/numbers.h"
#include "src/report/paths.h"
#include "src/report/run_data.h"
#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/text_table.h"
#include "trackbed/report/names.h"

// Computes the data of the comparisons that a report page shows. The pairs of plants to compare are
// listed in compare.json, in a comparison folder or next to the runs. Without compare.json, plants
// with equal names in different runs are compared; for a single run, all pairs of its plants. The
// differences between the plants are computed again from the logs. If the maxima of the recomputed
// differences do not match compare.json, the logs have changed, and the report fails with
// InputError. The difference curves are thinned such that those of all pairs together do not exceed
// a limit on the number of rows.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Maximum number of rows of all difference curves together. This row limit lets a single curve
/// have more rows than a chart has pixels, and keeps a page with ten pairs small.
constexpr std::size_t kCurveRows = 3000;

[[noreturn]] void FailOutdated(const fs::path& file, const std::string& message) {
  throw InputError(Problem{.file = file.string(), .message = message + "; compare the runs again"});
}

struct Drive {
  std::size_t run;
  std::string plant;

  [[nodiscard]] ordered_json ToJson() const { return {{"run", run}, {"plant", plant}}; }
};

struct Pair {
  Drive first;
  Drive second;
  /// entry of this pair of plants in compare.json; nullopt if there is no compare.json
  std::optional<JsonValue> outcome;
};

/// Adds the pairs and the verdict of the comparison in `folder` to `pairs` and `verdicts`. `at` is
/// the index of the first compared run.
void AddJudgedPairs(const fs::path& folder, const std::vector<fs::path>& runs, std::size_t at,
                    std::vector<Pair>& pairs, ordered_json& verdicts) {
  const JsonValue json = ReadJson(folder / run_folder::kCompareJson);
  const std::size_t last = ComparedRuns(folder).size() - 1;
  for (const JsonValue& pair : json.At("pairs").Elements()) {
    const std::vector<JsonValue> plants = pair.At("plants").Elements(2);
    // If compare.json compares two runs, its plant names consist of folder and plant, so only the
    // last part is used.
    const auto drive = [&](std::size_t which, std::size_t run) {
      return Drive{run, fs::path(plants[which].Text()).filename()};
    };
    pairs.push_back({drive(0, at), drive(1, at + last), pair});
  }
  verdicts.push_back(VerdictJson(json.At("verdict")));
  if (runs.size() > 1 && last == 0) {
    verdicts.back()["run"] = at;
  }
}

bool IsSelfComparison(const fs::path& run) {
  const std::vector<fs::path> runs = ComparedRuns(run);
  return std::all_of(runs.begin(), runs.end(), [&](const fs::path& other) {
    return fs::weakly_canonical(other) == fs::weakly_canonical(run);
  });
}

/// Adds a pair for each plant of the first run and the plant of the same name in every other run.
void AddPairsByName(const std::vector<std::vector<FinishedDrive>>& drives,
                    std::vector<Pair>& pairs) {
  for (std::size_t run = 1; run < drives.size(); ++run) {
    for (const FinishedDrive& first : drives[0]) {
      for (const FinishedDrive& second : drives[run]) {
        if (first.trace.name == second.trace.name) {
          pairs.push_back({{0, first.trace.name}, {run, second.trace.name}, {}});
        }
      }
    }
  }
}

/// Adds all pairs of plants of a single run.
void AddPairsOfRun(const std::vector<FinishedDrive>& drives, std::vector<Pair>& pairs) {
  for (std::size_t second = 1; second < drives.size(); ++second) {
    for (std::size_t first = 0; first < second; ++first) {
      pairs.push_back({{0, drives[first].trace.name}, {0, drives[second].trace.name}, {}});
    }
  }
}

/// Returns a note on each plant that has no plant of the same name in the other runs.
ordered_json UnpairedPlants(const std::vector<fs::path>& runs,
                            const std::vector<std::vector<FinishedDrive>>& drives) {
  ordered_json left_out = ordered_json::array();
  const auto take = [&](std::size_t run, std::size_t other) {
    for (const FinishedDrive& drive : drives[run]) {
      if (std::none_of(drives[other].begin(), drives[other].end(),
                       [&](const FinishedDrive& o) { return o.trace.name == drive.trace.name; })) {
        left_out.push_back(fmt::format("not compared: {} of {}, not in {}", drive.trace.name,
                                       runs[run].string(), runs[other].string()));
      }
    }
  };
  for (std::size_t run = 1; run < drives.size(); ++run) {
    take(0, run);
    take(run, 0);
  }
  return left_out;
}

/// Throws InputError if the logs of the runs, named by `logs`, have changed since the comparison
/// was made.
void RefuseIfChanged(const JsonValue& outcome, const PlantComparison& now,
                     const std::pair<fs::path, fs::path>& logs) {
  constexpr double kEqualityTolerance =
      1e-6;  // tolerance for differences in rounding between machines [m], [rad], [rad/s]
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    const std::optional<double> then = outcome.At(quantity.key).At("max").NumberOrNull();
    const double max = (now.*quantity.difference).max;
    // A null value in compare.json stands for a maximum difference that is not finite.
    if (then ? !(std::abs(*then - max) <= kEqualityTolerance) : std::isfinite(max)) {
      const auto text = [](double number) {
        return std::isfinite(number) ? ShortestText(number) : "null";
      };
      FailOutdated(outcome.file(),
                   fmt::format("{}.max is {}, but the logs {} and {} give {}", quantity.key,
                               then ? text(*then) : "null", logs.first.string(),
                               logs.second.string(), text(max)));
    }
  }
}

ordered_json CurveJson(const Table& differences, std::size_t row_limit) {
  const std::vector<std::pair<const char*, const char*>> columns{{"s", "s_m"},
                                                                 {"t", "first_t_s"},
                                                                 {"position", "position_m"},
                                                                 {"heading", "yaw_rad"},
                                                                 {"yaw_rate", "yaw_rate_radps"},
                                                                 {"steering", "steering_rad"}};
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
  for (const auto& [name, column] : columns) {
    names.emplace_back(name);
    values.push_back(differences.Column(column));
  }
  Table curve(names);
  for (std::size_t row = 0; row < differences.rows(); ++row) {
    std::vector<double> cells;
    for (const std::vector<double>& column : values) {
      cells.push_back(column[row]);
    }
    curve.AddRow(cells);
  }
  const std::vector<std::size_t> rows = RowsToShow(curve, row_limit);
  ordered_json json;
  for (const std::string& name : names) {
    json[name] = RoundedColumn(curve, name, rows);
  }
  return json;
}

/// Returns the tolerances for the differences of a pair of plants, keyed by the name of the
/// difference.
ordered_json TolerancesJson(const JsonValue& tolerances) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, bound] : tolerances.Members()) {
    json[name] = bound.Number();
  }
  return json;
}

ordered_json PairJson(const Pair& pair, const std::vector<fs::path>& runs, const Trace& first,
                      const Trace& second, std::size_t row_limit) {
  ordered_json json{{"first", pair.first.ToJson()}, {"second", pair.second.ToJson()}};
  const PlantComparison comparison = CompareTraces(first, second);
  if (pair.outcome) {
    json["tolerances"] = TolerancesJson(pair.outcome->At("tolerances"));
    const auto log = [&](const Drive& drive) {
      return runs[drive.run] / run_folder::LogCsv(drive.plant);
    };
    RefuseIfChanged(*pair.outcome, comparison, {log(pair.first), log(pair.second)});
  }
  if (comparison.comparable()) {
    ordered_json numbers = ToJson(comparison);
    numbers.erase("plants");
    json["numbers"] = NumbersJson(numbers, NameOfComparison);
    json["curve"] = CurveJson(DifferencesOverArcLength(first, second), row_limit);
  }
  return json;
}

}  // namespace

bool HasComparison(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / run_folder::kCompareJson, ignored);
}

std::vector<fs::path> ComparedRuns(const fs::path& folder) {
  const JsonValue json = ReadJson(folder / run_folder::kCompareJson);
  std::vector<fs::path> runs;
  const std::optional<JsonValue> names = json.Find("runs");
  for (const std::string& name : names ? names->Texts() : std::vector<std::string>()) {
    const fs::path path = folder / name;  // if the path of the run is absolute, `folder` has no
                                          // effect on the result
    if (runs.empty() || fs::weakly_canonical(runs.front()) != fs::weakly_canonical(path)) {
      runs.push_back(path);
    }
  }
  if (runs.empty() && IsRunFolder(folder)) {
    runs.push_back(folder);
  }
  if (runs.empty()) {
    FailOutdated(folder / run_folder::kCompareJson, "does not name its runs");
  }
  return runs;
}

ordered_json ComparisonData(const std::vector<fs::path>& runs,
                            const std::optional<fs::path>& judged) {
  std::vector<Pair> pairs;
  ordered_json verdicts = ordered_json::array();
  if (judged) {
    AddJudgedPairs(*judged, runs, 0, pairs, verdicts);
  } else {
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (HasComparison(runs[run]) && IsSelfComparison(runs[run])) {
        AddJudgedPairs(runs[run], runs, run, pairs, verdicts);
      }
    }
  }
  std::vector<std::vector<FinishedDrive>> drives;
  // Plants of an interrupted run are not compared, since they have driven different distances.
  const bool of_plants =
      pairs.empty() && runs.size() == 1 && PlantCount(runs.front()) > 1 && IsComplete(runs.front());
  if (!pairs.empty() || runs.size() > 1 || of_plants) {
    std::transform(runs.begin(), runs.end(), std::back_inserter(drives), ReadRunFolder);
  }
  if (of_plants) {
    AddPairsOfRun(drives.front(), pairs);
  }
  ordered_json left_out = ordered_json::array();
  if (!judged) {
    AddPairsByName(drives, pairs);
    left_out = UnpairedPlants(runs, drives);
  }
  if (pairs.empty() && verdicts.empty() && left_out.empty()) {
    return {};
  }
  ordered_json data{
      {"verdicts", verdicts}, {"left_out", left_out}, {"pairs", ordered_json::array()}};
  for (const Pair& pair : pairs) {
    const auto trace_of = [&](const Drive& drive) -> const Trace& {
      const auto found =
          std::find_if(drives[drive.run].begin(), drives[drive.run].end(),
                       [&](const FinishedDrive& other) { return other.trace.name == drive.plant; });
      if (found == drives[drive.run].end()) {
        FailOutdated(pair.outcome ? pair.outcome->file() : "",
                     fmt::format("of {}, which is not in {}", drive.plant,
                                 runs[drive.run].lexically_normal().string()));
      }
      return found->trace;
    };
    data["pairs"].push_back(PairJson(pair, runs, trace_of(pair.first), trace_of(pair.second),
                                     kCurveRows / pairs.size()));
  }
  return data;
}

}  // namespace trackbed
