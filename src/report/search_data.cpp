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

// number of intervals into which the range of a key is divided, to count the runs in each interval
constexpr std::size_t kIntervals = 10;

std::optional<std::size_t> FindColumn(const TextTable& table, const std::string& name) {
  const auto found = std::find(table.columns().begin(), table.columns().end(), name);
  return found == table.columns().end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - table.columns().begin()));
}

/// Divides the range of a search key into equal intervals. If the range is logarithmic, the ratio
/// of upper to lower end is the same for all intervals.
class Intervals {
 public:
  explicit Intervals(const JsonValue& distribution)
      : kind_(distribution.At("distribution").OneOf({"uniform", "log_uniform", "integer"})),
        from_(distribution.At("from").Number()),
        to_(distribution.At("to").Number()) {
    if (!(from_ < to_)) {
      distribution.At("to").Refuse("a number above from");
    }
    if (kind_ == "log_uniform" && !(from_ > 0.0)) {
      distribution.At("from").Refuse("a number above 0");
    }
    // A range of integers is also divided into intervals of equal width; if it has fewer than ten
    // integers, each integer is an interval.
    constexpr auto kMaxCount = static_cast<double>(kIntervals);
    count_ = kind_ == "integer" ? static_cast<std::size_t>(std::min(kMaxCount, to_ - from_ + 1.0))
                                : kIntervals;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] std::size_t Of(double value) const {
    const double place = kind_ == "log_uniform" ? std::log(value / from_) / std::log(to_ / from_)
                         : kind_ == "integer"   ? (value - from_ + 0.5) / (to_ - from_ + 1.0)
                                                : (value - from_) / (to_ - from_);
    const double interval = std::floor(place * static_cast<double>(count_));
    // Values of the key that are below the range or have no logarithm are counted in the first
    // interval.
    return interval > 0.0
               ? static_cast<std::size_t>(std::min(interval, static_cast<double>(count_ - 1)))
               : 0;
  }

 private:
  std::string kind_;
  double from_;
  double to_;
  std::size_t count_;
};

/// The rows of a study that have a value of the robustness, because their runs had a result.
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
  std::vector<double> robustness;  ///< robustness of the run in each row of `rows`
};

/// Returns the number of runs and the number of failures in each interval of a key's range.
ordered_json CoverageJson(const JsonValue& distribution, std::size_t column, const Runs& runs) {
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

/// Returns the runs of the search whose robustness is lower than that of all earlier runs, as pairs
/// of row and robustness.
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

/// Converts the entry of a key in `margins` of falsify.json for the page. The result contains the
/// range of the key's values, as a pair, in which the run passes if only this key is varied. If no
/// run passes on one side of the nominal value, the passing range ends at the nominal value.
ordered_json MarginJson(const JsonValue& margin) {
  const auto number = [&](const char* name) -> ordered_json {
    const std::optional<JsonValue> value = margin.Find(name);
    return value ? ordered_json(value->Number()) : ordered_json();
  };
  ordered_json json{{"sensitivity", number("sensitivity")}, {"holds_up_to", number("holds_up_to")}};
  if (const std::optional<JsonValue> alone = margin.Find("alone")) {
    const auto end = [&](const char* name) {
      const std::optional<JsonValue> side = alone->Find(name);
      return (side ? side->At("holds_up_to") : margin.At("nominal")).Number();
    };
    json["alone"] = {end("down"), end("up")};
  }
  return json;
}

ordered_json PointJson(const JsonValue& falsify, const char* name, std::size_t rows) {
  const std::optional<JsonValue> point = falsify.Find(name);
  if (!point) {
    return nullptr;
  }
  if (rows == 0) {
    point->Refuse("no point, as the table has no rows");
  }
  const std::optional<JsonValue> reason = point->Find("reason");
  return {{"row", point->At("row").Count(rows - 1)},
          {"robustness", Rounded(point->At("robustness").Number())},
          {"limit", point->At("limit").Text()},
          {"distance", Rounded(point->At("distance").Number())},
          {"reason", reason ? reason->Text() : std::string()},
          {"settings", point->At("settings").Scalars()}};
}

ordered_json KeysJson(const JsonValue& sweep, const JsonValue& falsify, const Runs& runs) {
  ordered_json keys = ordered_json::array();
  const std::optional<JsonValue> margins = falsify.Find("margins");
  for (const auto& [key, distribution] : sweep.At("vary").Members()) {
    const std::optional<std::size_t> column = FindColumn(runs.table, key);
    if (!column) {
      continue;
    }
    const ShownName name = NameOfKey(key);
    ordered_json json{{"name", key},
                      {"label", name.label},
                      {"unit", name.unit},
                      {"column", *column},
                      {"kind", distribution.At("distribution").Text()},
                      {"from", distribution.At("from").Number()},
                      {"to", distribution.At("to").Number()},
                      {"nominal", sweep.At("nominal").At(key).Number()}};
    json.update(CoverageJson(distribution, *column, runs));
    if (margins) {
      json["margin"] = MarginJson(margins->At(key));
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
  const JsonValue sweep = ReadJson(description);
  // If sweep.json has no `search`, the falsify.json in the same folder belongs to an earlier study.
  const std::optional<JsonValue> search = sweep.Find("search");
  if (!search) {
    return nullptr;
  }
  const JsonValue falsify = ReadJson(outcome);
  const std::size_t searched = falsify.At("runs").Count();
  const std::size_t shrunk = falsify.At("shrink_runs").Count();
  const std::string study = sweep.At("study").Text();
  const std::string own_study = falsify.At("study").Text();
  if (own_study != study || searched + shrunk > table.rows().size()) {
    throw InputError(Problem{
        .file = outcome.string(),
        .message = fmt::format(
            "is of other runs than {}, which has {} rows of {}; it is of {} runs of {}",
            run_folder::kSweepCsv, table.rows().size(), study, searched + shrunk, own_study)});
  }
  const Runs runs(table);
  const std::optional<JsonValue> complete = falsify.Find("shrunk_completely");
  ordered_json json{{"status", falsify.At("status").Text()},
                    {"method", search->At("method").Text()},
                    {"runs", searched},
                    {"shrink_runs", shrunk},
                    {"violations", falsify.At("violations").Count()},
                    {"out_of_time", falsify.At("out_of_time").Flag()},
                    {"shrunk_completely", !complete || complete->Flag()}};
  for (const char* point : {"first_violation", "least_robust", "counterexample"}) {
    json[point] = PointJson(falsify, point, table.rows().size());
  }
  if (const std::optional<JsonValue> result = falsify.Find("result")) {
    run_folder::RequireResult(file.parent_path() / run_folder::kCounterexample, result->Text(),
                              outcome);
  }
  if (const fs::path scenario =
          file.parent_path() / run_folder::kCounterexample / run_folder::kCounterexampleYaml;
      falsify.Find("counterexample") && fs::is_regular_file(scenario, ignored)) {
    json["scenario"] = scenario.string();
  }
  json["keys"] = KeysJson(sweep, falsify, runs);
  json["best"] = BestSoFar(runs, searched);
  return json;
}

}  // namespace trackbed
