#include "src/report/search_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "src/report/numbers.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/report/names.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kIntervals = 10;  // of a key's range, for what was tried of it

std::optional<std::size_t> FindColumn(const TextTable& table, const std::string& name) {
  const auto found = std::find(table.columns().begin(), table.columns().end(), name);
  return found == table.columns().end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - table.columns().begin()));
}

/// Equal parts of the range of a key; of a logarithmic one, equal ratios.
class Intervals {
 public:
  explicit Intervals(const ordered_json& distribution)
      : kind_(distribution.at("distribution").get<std::string>()),
        from_(distribution.at("from").get<double>()),
        to_(distribution.at("to").get<double>()) {
    // Each whole number is as wide as the others, and fewer than ten are not divided.
    count_ = kind_ == "integer" ? std::min(kIntervals, static_cast<std::size_t>(to_ - from_) + 1)
                                : kIntervals;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] std::size_t Of(double value) const {
    const double place = kind_ == "log_uniform" ? std::log(value / from_) / std::log(to_ / from_)
                         : kind_ == "integer"   ? (value - from_ + 0.5) / (to_ - from_ + 1.0)
                                                : (value - from_) / (to_ - from_);
    const double interval = std::floor(place * static_cast<double>(count_));
    return static_cast<std::size_t>(std::clamp(interval, 0.0, static_cast<double>(count_ - 1)));
  }

 private:
  std::string kind_;
  double from_;
  double to_;
  std::size_t count_;
};

/// The rows that have a robustness: what was run.
struct Runs {
  explicit Runs(const TextTable& all) : table(all) {
    const std::optional<std::size_t> column = FindColumn(all, "robustness");
    for (std::size_t row = 0; column && row < all.rows().size(); ++row) {
      if (const auto value = CellNumber(all.rows()[row][*column])) {
        rows.push_back(row);
        robustness.push_back(*value);
      }
    }
  }

  const TextTable& table;
  std::vector<std::size_t> rows;
  std::vector<double> robustness;  ///< of each of `rows`
};

/// How often each interval of a key was tried, and failed.
ordered_json CoverageJson(const ordered_json& distribution, std::size_t column, const Runs& runs) {
  const Intervals intervals(distribution);
  std::vector<std::size_t> tried(intervals.count(), 0);
  std::vector<std::size_t> failed(intervals.count(), 0);
  for (std::size_t i = 0; i < runs.rows.size(); ++i) {
    if (const auto value = CellNumber(runs.table.rows()[runs.rows[i]][column])) {
      const std::size_t interval = intervals.Of(*value);
      ++tried[interval];
      failed[interval] += runs.robustness[i] < 0.0 ? 1U : 0U;
    }
  }
  return {{"tried", tried}, {"failed", failed}};
}

/// The runs of the search that were lower than all before them: where steps of a line go down.
ordered_json BestSoFar(const Runs& runs, std::size_t searched) {
  ordered_json best = ordered_json::array();
  std::optional<double> least;
  for (std::size_t i = 0; i < runs.rows.size() && runs.rows[i] < searched; ++i) {
    if (!least || runs.robustness[i] < *least) {
      least = runs.robustness[i];
      best.push_back({runs.rows[i], Rounded(*least)});
    }
  }
  return best;
}

/// A key of `margins` in falsify.json, with the ends of where it holds alone as a pair. Where no
/// run to a side told of them, the nominal value is that end.
ordered_json MarginJson(const ordered_json& margin) {
  ordered_json json{{"sensitivity", margin.value("sensitivity", ordered_json())},
                    {"holds_up_to", margin.value("holds_up_to", ordered_json())}};
  if (const auto alone = margin.find("alone"); alone != margin.end()) {
    const auto end = [&](const char* side) -> ordered_json {
      return alone->contains(side) ? alone->at(side).at("holds_up_to").get<double>()
                                   : margin.at("nominal").get<double>();
    };
    json["alone"] = {end("down"), end("up")};
  }
  return json;
}

ordered_json PointJson(const ordered_json& falsify, const char* name) {
  if (!falsify.contains(name)) {
    return nullptr;
  }
  const ordered_json& point = falsify.at(name);
  return {{"row", point.at("row").get<std::size_t>()},
          {"robustness", Rounded(point.at("robustness").get<double>())},
          {"limit", point.at("limit").get<std::string>()},
          {"distance", Rounded(point.at("distance").get<double>())},
          {"reason", point.value("reason", std::string())},
          {"settings", point.at("settings")}};
}

ordered_json KeysJson(const ordered_json& sweep, const ordered_json& falsify, const Runs& runs) {
  ordered_json keys = ordered_json::array();
  for (const auto& [key, distribution] : sweep.at("vary").items()) {
    const std::optional<std::size_t> column = FindColumn(runs.table, key);
    if (!column) {
      continue;
    }
    const ShownName name = NameOfKey(key);
    ordered_json json{{"name", key},
                      {"label", name.label},
                      {"unit", name.unit},
                      {"column", *column},
                      {"kind", distribution.at("distribution").get<std::string>()},
                      {"from", distribution.at("from").get<double>()},
                      {"to", distribution.at("to").get<double>()},
                      {"nominal", sweep.at("nominal").at(key).get<double>()}};
    json.update(CoverageJson(distribution, *column, runs));
    if (falsify.contains("margins")) {
      json["margin"] = MarginJson(falsify.at("margins").at(key));
    }
    keys.push_back(std::move(json));
  }
  return keys;
}

}  // namespace

ordered_json SearchData(const fs::path& file, const TextTable& table) {
  const fs::path outcome = file.parent_path() / run_folder::kFalsifyJson;
  const fs::path description = file.parent_path() / run_folder::kSweepJson;
  std::error_code ignored;
  if (file.filename() != run_folder::kSweepCsv || !fs::is_regular_file(outcome, ignored) ||
      !fs::is_regular_file(description, ignored)) {
    return nullptr;
  }
  const auto sweep = ReadJson(description, [](const ordered_json& json) { return json; });
  // An earlier search may have left its outcome in the folder of another study.
  if (!sweep.contains("search")) {
    return nullptr;
  }
  return ReadJson(outcome, [&](const ordered_json& falsify) -> ordered_json {
    const auto searched = falsify.at("runs").get<std::size_t>();
    const auto shrunk = falsify.at("shrink_runs").get<std::size_t>();
    if (falsify.at("study") != sweep.at("study") || searched + shrunk > table.rows().size()) {
      throw InputError(Problem{
          .file = outcome.string(),
          .message = fmt::format("is of other runs than {}, which has {} rows of {}; it is of {} "
                                 "runs of {}",
                                 run_folder::kSweepCsv, table.rows().size(),
                                 sweep.at("study").get<std::string>(), searched + shrunk,
                                 falsify.at("study").get<std::string>())});
    }
    const Runs runs(table);
    ordered_json json{{"status", falsify.at("status").get<std::string>()},
                      {"method", sweep.at("search").at("method").get<std::string>()},
                      {"runs", searched},
                      {"shrink_runs", shrunk},
                      {"violations", falsify.at("violations").get<std::size_t>()},
                      {"out_of_time", falsify.at("out_of_time").get<bool>()},
                      {"shrunk_completely", falsify.value("shrunk_completely", true)}};
    for (const char* point : {"first_violation", "least_robust", "counterexample"}) {
      json[point] = PointJson(falsify, point);
    }
    if (const fs::path scenario =
            file.parent_path() / run_folder::kCounterexample / run_folder::kCounterexampleYaml;
        falsify.contains("counterexample") && fs::is_regular_file(scenario, ignored)) {
      json["scenario"] = scenario.string();
    }
    json["keys"] = KeysJson(sweep, falsify, runs);
    json["best"] = BestSoFar(runs, searched);
    return json;
  });
}

}  // namespace trackbed
