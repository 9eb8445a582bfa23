#include "src/report/study_difference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <vector>

#include "src/report/numbers.h"
#include "src/report/study_statistics.h"
#include "trackbed/analysis/statistics.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;
using Cells = std::vector<std::string>;

std::size_t PlaceOf(const TextTable& table, const std::string& column) {
  return static_cast<std::size_t>(
      std::find(table.columns().begin(), table.columns().end(), column) - table.columns().begin());
}

Cells ParametersOf(const TextTable& table) {
  return {table.columns().begin(),
          table.columns().begin() + static_cast<std::ptrdiff_t>(PlaceOf(table, "status"))};
}

/// Returns the row number of each row, keyed by the settings of the row.
std::map<Cells, std::size_t> RowsBySetting(const TextTable& table, const std::string& file) {
  const auto parameters = static_cast<std::ptrdiff_t>(PlaceOf(table, "status"));
  std::map<Cells, std::size_t> rows;
  for (std::size_t row = 0; row < table.rows().size(); ++row) {
    const Cells& cells = table.rows()[row];
    if (!rows.try_emplace(Cells(cells.begin(), cells.begin() + parameters), row).second) {
      throw InputError(Problem{file, static_cast<int>(row) + 2, 0, "",
                               "sets the same as an earlier row, so that it cannot be compared "
                               "with one of another study"});
    }
  }
  return rows;
}

struct RowPair {
  const Cells* before;
  const Cells* after;
};

ordered_json DescribePairs(const std::string& name, const std::vector<double>& before,
                           const std::vector<double>& after) {
  const PairedDifference pairs = ComparePairs(before, after, 0.95);
  const std::optional<Interval>& interval = pairs.mean.interval;
  return {{"name", name},
          {"count", before.size()},
          {"before", Rounded(EstimateMean(before, 0.95).mean)},
          {"after", Rounded(EstimateMean(after, 0.95).mean)},
          {"mean", Rounded(pairs.mean.mean)},
          {"interval", interval ? ordered_json{Rounded(interval->low), Rounded(interval->high)}
                                : ordered_json()},
          {"median", Rounded(pairs.median)},
          {"higher", pairs.higher},
          {"lower", pairs.lower},
          {"equal", pairs.equal},
          {"sign_test", Rounded(pairs.sign_test)}};
}

}  // namespace

ordered_json StudyDifference(const TextTable& before, const std::string& before_file,
                             const TextTable& after, const std::string& after_file) {
  const Cells parameters = ParametersOf(after);
  if (ParametersOf(before) != parameters) {
    throw InputError(Problem{
        .file = after_file,
        .message = fmt::format("varies other keys ({}) than {} ({})", fmt::join(parameters, ", "),
                               before_file, fmt::join(ParametersOf(before), ", "))});
  }
  const std::map<Cells, std::size_t> rows_before = RowsBySetting(before, before_file);
  const std::map<Cells, std::size_t> rows_after = RowsBySetting(after, after_file);
  std::vector<RowPair> pairs;
  for (const auto& [setting, row] : rows_after) {
    if (const auto found = rows_before.find(setting); found != rows_before.end()) {
      pairs.push_back({&before.rows()[found->second], &after.rows()[row]});
    }
  }
  if (pairs.empty()) {
    throw InputError(
        Problem{.file = after_file,
                .message = fmt::format("has no row that sets the same as one of {}", before_file)});
  }
  ordered_json json{{"rows", pairs.size()},
                    {"only_before", rows_before.size() - pairs.size()},
                    {"only_after", rows_after.size() - pairs.size()},
                    {"outputs", ordered_json::array()}};
  const std::size_t status_before = PlaceOf(before, "status");
  const std::size_t status_after = PlaceOf(after, "status");
  std::vector<double> first;
  std::vector<double> second;
  for (const RowPair& pair : pairs) {
    first.push_back(HasPassed((*pair.before)[status_before]) ? 1.0 : 0.0);
    second.push_back(HasPassed((*pair.after)[status_after]) ? 1.0 : 0.0);
  }
  json["outputs"].push_back(DescribePairs("passed", first, second));
  for (std::size_t column = status_after + 1; column < after.columns().size(); ++column) {
    const std::string& name = after.columns()[column];
    const std::size_t other = PlaceOf(before, name);
    if (other == before.columns().size() || name == "runs" || name == "reason") {
      continue;
    }
    first.clear();
    second.clear();
    for (const RowPair& pair : pairs) {
      const std::optional<double> one = CellNumber((*pair.before)[other]);
      const std::optional<double> two = CellNumber((*pair.after)[column]);
      if (one && two) {
        first.push_back(*one);
        second.push_back(*two);
      }
    }
    if (!first.empty()) {
      json["outputs"].push_back(DescribePairs(name, first, second));
    }
  }
  return json;
}

}  // namespace trackbed
