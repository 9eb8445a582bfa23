#include "src/report/numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace trackbed {
namespace {

/// Returns the indices of the first and the last row of the table. The returned indices also
/// contain the rows with the minimum and maximum of each column in each of `stretches` equal parts
/// of the table.
std::vector<std::size_t> ExtremeRows(const Table& table, std::size_t stretches) {
  std::set<std::size_t> rows{0, table.rows() - 1};
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = k * table.rows() / stretches;
    const std::size_t end = (k + 1) * table.rows() / stretches;
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
      std::size_t least = begin;
      std::size_t most = begin;
      for (std::size_t row = begin; row < end; ++row) {
        least = table.at(row, column) < table.at(least, column) ? row : least;
        most = table.at(row, column) > table.at(most, column) ? row : most;
      }
      rows.insert({least, most});
    }
  }
  return {rows.begin(), rows.end()};
}

}  // namespace

double Rounded(double value) {
  constexpr double kZeroTolerance = 5e-7;
  if (std::abs(value) < kZeroTolerance) {
    return 0.0;
  }
  const std::string text = fmt::format("{:.6g}", value);
  double rounded = value;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

nlohmann::ordered_json RoundedColumn(const Table& table, const std::string& column,
                                     const std::vector<std::size_t>& rows) {
  const std::vector<double> values = table.Column(column);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::size_t row : rows) {
    json.push_back(Rounded(values[row]));
  }
  return json;
}

std::vector<std::size_t> RowsToShow(const Table& table, std::size_t limit) {
  if (table.rows() <= limit) {
    std::vector<std::size_t> all(table.rows());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  // Doubles the number of parts of the table until the number of selected rows would exceed the
  // limit. The number of selected rows is not known in advance, because several columns often have
  // their extremes in the same row.
  std::vector<std::size_t> rows = ExtremeRows(table, 1);
  for (std::size_t stretches = 2; stretches < table.rows(); stretches *= 2) {
    std::vector<std::size_t> more = ExtremeRows(table, stretches);
    if (more.size() > limit) {
      break;
    }
    rows = std::move(more);
  }
  return rows;
}

}  // namespace trackbed
