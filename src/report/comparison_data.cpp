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
#include "trackbed/report/names.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Rows of all curves together: a chart has no more pixels, and ten pairs are much.
constexpr std::size_t kCurveRows = 3000;

[[noreturn]] void Unfit(const fs::path& file, const std::string& message) {
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
  fs::path file;         ///< where it has been judged; empty if nowhere
  ordered_json outcome;  ///< what stands there about it
};

/// The pairs of a comparison and its verdict. The runs are those from `at` on.
void TakeJudged(const fs::path& folder, const std::vector<fs::path>& runs, std::size_t at,
                std::vector<Pair>& pairs, ordered_json& verdicts) {
  const fs::path file = folder / run_folder::kCompareJson;
  VisitJson(file, [&](const ordered_json& json) {
    const std::size_t last = ComparedRuns(folder).size() - 1;
    for (const ordered_json& pair : json.at("pairs")) {
      // Of two runs, a run is named after its folder and its plant.
      const auto drive = [&](std::size_t which, std::size_t run) {
        return Drive{run, fs::path(pair.at("plants").at(which).get<std::string>()).filename()};
      };
      pairs.push_back({drive(0, at), drive(1, at + last), file, pair});
    }
    verdicts.push_back(VerdictJson(json.at("verdict")));
    if (runs.size() > 1 && last == 0) {
      verdicts.back()["run"] = at;
    }
  });
}

bool IsOfItself(const fs::path& run) {
  const std::vector<fs::path> runs = ComparedRuns(run);
  return std::all_of(runs.begin(), runs.end(), [&](const fs::path& other) {
    return fs::weakly_canonical(other) == fs::weakly_canonical(run);
  });
}

/// Each plant of the first run with its namesake in every other.
void TakeNamesakes(const std::vector<std::vector<FinishedDrive>>& drives,
                   std::vector<Pair>& pairs) {
  for (std::size_t run = 1; run < drives.size(); ++run) {
    for (const FinishedDrive& first : drives[0]) {
      for (const FinishedDrive& second : drives[run]) {
        if (first.trace.name == second.trace.name) {
          pairs.push_back({{0, first.trace.name}, {run, second.trace.name}, {}, {}});
        }
      }
    }
  }
}

/// Each two plants of one run.
void TakePlants(const std::vector<FinishedDrive>& drives, std::vector<Pair>& pairs) {
  for (std::size_t second = 1; second < drives.size(); ++second) {
    for (std::size_t first = 0; first < second; ++first) {
      pairs.push_back({{0, drives[first].trace.name}, {0, drives[second].trace.name}, {}, {}});
    }
  }
}

/// What of the runs has no namesake in the first, and what of the first has none in another.
ordered_json LeftOut(const std::vector<fs::path>& runs,
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

/// The logs may be others than those that were compared.
void RefuseIfChanged(const Pair& pair, const PlantComparison& now) {
  constexpr double kSame = 1e-6;  // [m], [rad], [rad/s]: of rounding on another machine
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    const double then = pair.outcome.at(quantity.key).at("max").get<double>();
    if (!(std::abs(then - (now.*quantity.difference).max) <= kSame)) {
      Unfit(pair.file, "does not match the runs' current logs");
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

ordered_json PairJson(const Pair& pair, const Trace& first, const Trace& second,
                      std::size_t row_limit) {
  ordered_json json{{"first", pair.first.ToJson()}, {"second", pair.second.ToJson()}};
  if (!pair.file.empty()) {
    json["tolerances"] = pair.outcome.at("tolerances");
  }
  const PlantComparison comparison = CompareTraces(first, second);
  if (!pair.file.empty()) {
    RefuseIfChanged(pair, comparison);
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
  return ReadJson(folder / run_folder::kCompareJson, [&](const ordered_json& json) {
    std::vector<fs::path> runs;
    for (const ordered_json& run : json.value("runs", ordered_json::array())) {
      const fs::path path = folder / run.get<std::string>();  // one from the root on stays so
      if (runs.empty() || fs::weakly_canonical(runs.front()) != fs::weakly_canonical(path)) {
        runs.push_back(path);
      }
    }
    if (runs.empty() && IsRunFolder(folder)) {
      runs.push_back(folder);
    }
    if (runs.empty()) {
      Unfit(folder / run_folder::kCompareJson, "does not name its runs");
    }
    return runs;
  });
}

ordered_json ComparisonData(const std::vector<fs::path>& runs,
                            const std::optional<fs::path>& judged) {
  std::vector<Pair> pairs;
  ordered_json verdicts = ordered_json::array();
  if (judged) {
    TakeJudged(*judged, runs, 0, pairs, verdicts);
  } else {
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (HasComparison(runs[run]) && IsOfItself(runs[run])) {
        TakeJudged(runs[run], runs, run, pairs, verdicts);
      }
    }
  }
  std::vector<std::vector<FinishedDrive>> drives;
  // Plants of an interrupted run have not come equally far.
  const bool of_plants =
      pairs.empty() && runs.size() == 1 && PlantCount(runs.front()) > 1 && IsComplete(runs.front());
  if (!pairs.empty() || runs.size() > 1 || of_plants) {
    std::transform(runs.begin(), runs.end(), std::back_inserter(drives), ReadRunFolder);
  }
  if (of_plants) {
    TakePlants(drives.front(), pairs);
  }
  ordered_json left_out = ordered_json::array();
  if (!judged) {
    TakeNamesakes(drives, pairs);
    left_out = LeftOut(runs, drives);
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
        Unfit(pair.file,
              fmt::format("of {}, which is not in {}", drive.plant, runs[drive.run].string()));
      }
      return found->trace;
    };
    data["pairs"].push_back(
        PairJson(pair, trace_of(pair.first), trace_of(pair.second), kCurveRows / pairs.size()));
  }
  return data;
}

}  // namespace trackbed
