#include "trackbed/analysis/compare_runs.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/run_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

// Compares the plants of one run, or the plants of two finished runs, pairwise at equal stations
// (compare.cpp). Within one run, each plant is compared with every other plant. Between two runs,
// plants with equal names are compared, unless the user names the two plants to compare. Bounds on
// the differences come from the given tolerances and, for plants of one run, from expect.between;
// the tightest bound applies. The verdict of a comparison also notes if the runs end with different
// statuses, have different plans, or have different plants.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Returns only those expectations on a plant that concern how the run ends and how large the
/// cross-track error is.
PlantExpectation EndExpectations(const PlantExpectation& expect) {
  PlantExpectation end{.max_cross_track = expect.max_cross_track, .collision = expect.collision};
  std::copy_if(expect.metrics.begin(), expect.metrics.end(), std::back_inserter(end.metrics),
               [](const MetricExpectation& metric) { return metric.metric == "status"; });
  return end;
}

Expectations EndExpectations(const Expectations& expect) {
  Expectations ends{.all = EndExpectations(expect.all)};
  for (const auto& [plant, own] : expect.plants) {
    ends.plants.emplace_back(plant, EndExpectations(own));
  }
  return ends;
}

void Tighten(std::optional<double>& bound, const std::optional<double>& other) {
  if (other) {
    bound = std::min(bound.value_or(*other), *other);
  }
}

/// Returns the tightest of all bounds on the differences between plants `a` and `b`.
DifferenceBounds BoundsBetween(const Expectations& expect, const std::string& a,
                               const std::string& b) {
  DifferenceBounds bounds;
  for (const BetweenExpectation& between : expect.between) {
    if (std::is_permutation(between.plants.begin(), between.plants.end(),
                            std::vector{a, b}.begin())) {
      for (const ComparedQuantity& quantity : ComparedQuantities()) {
        Tighten(bounds.*quantity.bound, between.bounds.*quantity.bound);
      }
    }
  }
  return bounds;
}

ComparedPair Pair(const Trace& first, const Trace& second, const DifferenceBounds& bounds) {
  return {CompareTraces(first, second), bounds, DifferencesOverArcLength(first, second)};
}

/// Adds to the verdict the checks of the differences between two compared plants.
void Judge(const ComparedPair& pair, Verdict& verdict) {
  if (pair.bounds.any() || !pair.comparison.comparable()) {
    for (Check& check : CheckBounds(pair.bounds, pair.comparison)) {
      AddCheck(std::move(check), verdict);
    }
  }
  verdict.passed = verdict.failures.empty();
}

/// A finished run, read from its folder.
struct FinishedRun {
  fs::path folder;
  std::string name;  ///< short name of the run, used in the results of the comparison
  std::vector<FinishedDrive> drives;
  Expectations expect;

  [[nodiscard]] std::vector<std::string> Plants() const {
    std::vector<std::string> plants;
    for (const FinishedDrive& drive : drives) {
      plants.push_back(drive.trace.name);
    }
    return plants;
  }

  [[nodiscard]] const FinishedDrive& Of(const std::string& plant) const {
    const auto found = std::find_if(drives.begin(), drives.end(), [&](const FinishedDrive& drive) {
      return drive.trace.name == plant;
    });
    if (found == drives.end()) {
      throw InputError(Problem{.file = folder.string(),
                               .message = fmt::format("the run has no plant {}; it has: {}", plant,
                                                      fmt::join(Plants(), ", "))});
    }
    return *found;
  }
};

FinishedRun ReadRun(const fs::path& folder, const std::string& name) {
  FinishedRun run{.folder = folder, .name = name, .drives = ReadRunFolder(folder), .expect = {}};
  if (run.drives.empty()) {
    throw InputError(
        Problem{.file = folder.string(), .message = "the run has no logs: it had no plan"});
  }
  if (const fs::path scenario = folder / run_folder::kScenarioYaml; fs::exists(scenario)) {
    run.expect = ReadExpectations(run_folder::RequireFile(scenario));
  }
  return run;
}

/// The runs of two plants to compare, with distinct names, and the bounds on the differences.
struct Candidates {
  FinishedDrive first;
  FinishedDrive second;
  DifferenceBounds bounds;
};

std::vector<Candidates> CandidatesWithinRun(const FinishedRun& run,
                                            const std::vector<std::string>& wanted) {
  const std::vector<std::string> plants = wanted.empty() ? run.Plants() : wanted;
  std::vector<Candidates> pairs;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    for (std::size_t j = i + 1; j < plants.size(); ++j) {
      pairs.push_back(
          {run.Of(plants[i]), run.Of(plants[j]), BoundsBetween(run.expect, plants[i], plants[j])});
    }
  }
  if (pairs.empty()) {
    throw InputError(
        Problem{.file = run.folder.string(),
                .message = fmt::format("only {}; comparing needs two plants or a second run",
                                       fmt::join(plants, ", "))});
  }
  return pairs;
}

std::vector<Candidates> AcrossTwo(const FinishedRun& first, const FinishedRun& second,
                                  const std::vector<std::string>& wanted) {
  std::vector<Candidates> pairs;
  const auto add = [&](const std::string& a, const std::string& b) {
    Candidates pair{first.Of(a), second.Of(b), {}};
    pair.first.trace.name = first.name + "/" + a;
    pair.second.trace.name = second.name + "/" + b;
    pairs.push_back(std::move(pair));
  };
  if (wanted.size() == 2) {
    add(wanted[0], wanted[1]);
    return pairs;
  }
  for (const std::string& plant : wanted.empty() ? first.Plants() : wanted) {
    const std::vector<std::string> others = second.Plants();
    if (!wanted.empty() || std::find(others.begin(), others.end(), plant) != others.end()) {
      add(plant, plant);
    }
  }
  if (pairs.empty()) {
    throw InputError(Problem{
        .file = second.folder.string(),
        .message =
            fmt::format("no plant in common with {}; plants: {} and {}", first.folder.string(),
                        fmt::join(first.Plants(), ", "), fmt::join(second.Plants(), ", "))});
  }
  return pairs;
}

/// Adds a note to the verdict for each plant that only one of the two runs has.
void NoteUnpairedPlants(const FinishedRun& first, const FinishedRun& second, Verdict& verdict) {
  for (const auto& [run, other] : {std::pair(&first, &second), std::pair(&second, &first)}) {
    std::vector<std::string> alone;
    const std::vector<std::string> others = other->Plants();
    for (const std::string& plant : run->Plants()) {
      if (std::find(others.begin(), others.end(), plant) == others.end()) {
        alone.push_back(plant);
      }
    }
    if (!alone.empty()) {
      verdict.notes.push_back(
          fmt::format("not compared: {}, only in {}", fmt::join(alone, ", "), run->name));
    }
  }
}

void RefuseTwice(const std::vector<std::string>& plants) {
  for (auto plant = plants.begin(); plant != plants.end(); ++plant) {
    if (std::find(plants.begin(), plant, *plant) != plant) {
      throw InputError(
          Problem{.file = "--plants", .message = fmt::format("'{}' is listed twice", *plant)});
    }
  }
}

/// Converts the planned path in plan.csv to a trace, so that two plans can be compared like two
/// runs. Throws InputError, naming the file, if a column is missing.
Trace PathIn(const Table& plan, const fs::path& file) {
  const auto column = [&](const char* name) {
    if (plan.Find(name) < 0) {
      throw InputError(Problem{file.string(), 1, 0, name, "no such column"});
    }
    return plan.Column(name);
  };
  Trace trace{.station = column("s_m")};
  const auto x = column("x_m");
  const auto y = column("y_m");
  const auto yaw = column("yaw_rad");
  for (std::size_t i = 0; i < plan.rows(); ++i) {
    trace.pose.push_back({x[i], y[i], yaw[i]});
  }
  trace.origin = OriginIn(plan);
  trace.time = trace.yaw_rate = trace.steering = std::vector<double>(plan.rows(), 0.0);
  return trace;
}

/// Largest difference between two plans that counts as a rounding difference, such as between
/// different builds of Trackbed [m, rad, m/s].
constexpr double kRounding = 1e-6;

bool HaveSameRows(const Table& first, const Table& second) {
  if (first.columns() != second.columns() || first.rows() != second.rows()) {
    return false;
  }
  for (std::size_t row = 0; row < first.rows(); ++row) {
    for (std::size_t column = 0; column < first.columns().size(); ++column) {
      if (!(std::abs(first.at(row, column) - second.at(row, column)) <= kRounding)) {
        return false;
      }
    }
  }
  return true;
}

/// Adds a note to the verdict if the two runs have different plans, since a comparison usually
/// assumes a common plan.
void NoteOtherPlan(const FinishedRun& first, const FinishedRun& second, Verdict& verdict) {
  const fs::path plan_of_first = first.folder / run_folder::kPlanCsv;
  const fs::path plan_of_second = second.folder / run_folder::kPlanCsv;
  const bool has_first = fs::exists(plan_of_first);
  const bool has_second = fs::exists(plan_of_second);
  if (!has_first && !has_second) {
    return;
  }
  if (has_first != has_second) {
    verdict.notes.push_back(
        fmt::format("only {} followed a plan", (has_first ? first : second).name));
    return;
  }
  const Table plan_1 = ReadCsv(run_folder::RequireFile(plan_of_first));
  const Table plan_2 = ReadCsv(run_folder::RequireFile(plan_of_second));
  if (HaveSameRows(plan_1, plan_2)) {
    return;
  }
  const auto length = [](const Trace& path) {
    return path.station.empty() ? 0.0 : path.station.back();
  };
  const Trace path_1 = PathIn(plan_1, plan_of_first);
  const Trace path_2 = PathIn(plan_2, plan_of_second);
  const Difference apart = CompareTraces(path_1, path_2).position;
  const bool one_path =
      apart.max <= kRounding && std::abs(length(path_1) - length(path_2)) <= kRounding;
  verdict.notes.push_back(
      one_path ? "the runs follow the same path at different speeds"
               : fmt::format("the runs follow different paths, {:.4g} m and {:.4g} m long, up to "
                             "{:.4g} m apart at s = {:.4g} m",
                             length(path_1), length(path_2), apart.max, apart.max_s));
}

ordered_json BoundsJson(const DifferenceBounds& bounds) {
  ordered_json json = ordered_json::object();
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    if (const std::optional<double>& limit = bounds.*quantity.bound) {
      json[std::string(quantity.key) + "_max"] = *limit;
    }
  }
  return json;
}

[[noreturn]] void BadTolerance(const std::string& message) {
  throw InputError(Problem{.file = "--tolerance", .message = message});
}

}  // namespace

bool RunComparison::judged() const {
  return std::any_of(pairs.begin(), pairs.end(),
                     [](const ComparedPair& pair) { return pair.bounds.any(); });
}

const char* RunComparison::status() const {
  return !verdict.passed ? "failed" : judged() ? "passed" : "compared";
}

RunComparison CompareRun(const RunResult& run, const std::optional<DifferenceBounds>& tolerances) {
  RunComparison result;
  if (!run.plan.ok()) {
    result.verdict = run.verdict;
    return result;
  }
  result.verdict = trackbed::Judge(EndExpectations(run.scenario.expect), run.metrics, {});
  result.verdict.passed = result.verdict.failures.empty();
  for (std::size_t i = 0; i < run.logs.size(); ++i) {
    for (std::size_t j = i + 1; j < run.logs.size(); ++j) {
      const Trace first = MakeTrace(run.logs[i]);
      const Trace second = MakeTrace(run.logs[j]);
      result.pairs.push_back(
          Pair(first, second,
               tolerances.value_or(BoundsBetween(run.scenario.expect, first.name, second.name))));
      Judge(result.pairs.back(), result.verdict);
    }
  }
  return result;
}

RunComparison CompareFolders(const std::vector<fs::path>& folders,
                             const std::vector<std::string>& plants,
                             const std::optional<DifferenceBounds>& tolerances) {
  TRACKBED_CHECK(folders.size() == 1 || folders.size() == 2, "{} folders", folders.size());
  if (folders.size() == 1 || plants.size() != 2) {
    RefuseTwice(plants);
  }
  const run_folder::Reading reading(folders);
  std::vector<FinishedRun> runs;
  const std::vector<std::string> names = ShortRunNames(folders);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    runs.push_back(ReadRun(folders[i], names[i]));
  }
  const std::vector<Candidates> candidates =
      runs.size() == 1 ? CandidatesWithinRun(runs[0], plants) : AcrossTwo(runs[0], runs[1], plants);
  RunComparison result{.runs = folders};
  if (runs.size() == 2) {
    NoteOtherPlan(runs[0], runs[1], result.verdict);
    if (plants.empty()) {
      NoteUnpairedPlants(runs[0], runs[1], result.verdict);
    }
  }
  reading.RequireUnchanged();
  for (const auto& [first, second, expected] : candidates) {
    const DifferenceBounds bounds = tolerances.value_or(expected);
    Check ends{.plant = first.trace.name,
               .other = second.trace.name,
               .metric = "status",
               .relation = Relation::kEquals,
               .bound = first.status,
               .value = second.status,
               .met = first.status == second.status,
               .reason = CheckReason::kSameEnd};
    if (bounds.any()) {
      AddCheck(std::move(ends), result.verdict);
    } else if (!ends.met) {
      result.verdict.notes.push_back(FailureMessage(ends));
    }
    result.pairs.push_back(Pair(first.trace, second.trace, bounds));
    Judge(result.pairs.back(), result.verdict);
  }
  return result;
}

DifferenceBounds ParseTolerances(const std::vector<std::string>& texts) {
  DifferenceBounds bounds;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos) {
      BadTolerance(fmt::format("expected NAME=VALUE such as position=0.1, found '{}'", text));
    }
    const std::string value = text.substr(equals + 1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number) ||
        number < 0.0) {
      BadTolerance(fmt::format("{}: expected a number of at least 0, found '{}'", name, value));
    }
    const std::vector<ComparedQuantity>& known = ComparedQuantities();
    const auto quantity =
        std::find_if(known.begin(), known.end(), [&](const auto& own) { return own.key == name; });
    if (quantity == known.end()) {
      std::vector<std::string> names;
      for (const ComparedQuantity& own : known) {
        names.emplace_back(own.key);
      }
      BadTolerance("unknown " + UnknownName(name, names));
    }
    std::optional<double>& bound = bounds.*quantity->bound;
    if (bound) {
      BadTolerance(name + ": given twice");
    }
    bound = number;
  }
  return bounds;
}

void WriteComparison(const RunComparison& comparison, const OutputFolder& folder) {
  ResultWriter writer(folder);
  AddComparison(comparison, folder.path(), writer);
  writer.Commit();
}

void AddComparison(const RunComparison& comparison, const fs::path& folder, ResultWriter& writer) {
  std::vector<std::string> columns{"pair"};
  const Table any = DifferencesOverArcLength({}, {});
  columns.insert(columns.end(), any.columns().begin(), any.columns().end());
  Table table(columns);
  ordered_json json{{"status", comparison.status()}};
  for (const fs::path& run : comparison.runs) {
    // Write the path of each run relative to the comparison's folder, even if the user gave an
    // absolute path.
    json["runs"].push_back(fs::relative(run, folder).generic_string());
  }
  json["pairs"] = ordered_json::array();
  for (std::size_t pair = 0; pair < comparison.pairs.size(); ++pair) {
    const ComparedPair& own = comparison.pairs[pair];
    for (std::size_t row = 0; row < own.differences.rows(); ++row) {
      std::vector<double> cells{static_cast<double>(pair)};
      for (std::size_t column = 0; column < any.columns().size(); ++column) {
        cells.push_back(own.differences.at(row, column));
      }
      table.AddRow(cells);
    }
    json["pairs"].push_back(ToJson(own.comparison));
    json["pairs"].back()["tolerances"] = BoundsJson(own.bounds);
  }
  json["verdict"] = ToJson(comparison.verdict);
  if (comparison.verdict.passed && !comparison.judged()) {
    json["verdict"]["passed"] = nullptr;
  }
  json["versions"] = Versions();
  writer.Add(run_folder::kCompareCsv, table.ToCsv());
  writer.Add(run_folder::kCompareJson, JsonText(json));
  writer.EndResult(run_folder::kComparison, {run_folder::kReport});
}

}  // namespace trackbed
