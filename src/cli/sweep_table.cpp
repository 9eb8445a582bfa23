#include "src/cli/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "src/cli/text_columns.h"
#include "trackbed/analysis/statistics.h"
#include "trackbed/report/names.h"

namespace trackbed::cli {
namespace {

constexpr std::size_t kMaxRowsInFull = 24;

std::vector<std::string> WordsOf(const std::string& text, char separator) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, separator);) {
    words.push_back(word);
  }
  return words;
}

std::string Rounded(const std::string& cell) {
  const std::optional<double> number = CellNumber(cell);
  return number ? fmt::format("{:.4g}", *number) : cell.empty() ? "-" : cell;
}

std::vector<std::string> CellsOf(const TextTable& table, std::size_t column) {
  std::vector<std::string> cells;
  std::transform(table.rows().begin(), table.rows().end(), std::back_inserter(cells),
                 [&](const auto& row) { return row[column]; });
  return cells;
}

/// Formats the parameters, status and outputs of all rows of a study as a table. The table omits
/// the column `reason`, because its texts are too long for a table.
std::string RowsText(const TextTable& table, std::size_t status, std::size_t width) {
  TextColumns columns;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < table.columns().size(); ++i) {
    const std::string& name = table.columns()[i];
    if (name == "reason") {
      continue;
    }
    TextColumn column;
    if (i < status) {
      column.words = WordsOf(name, '.');
      column.unit = NameOfKey(name).unit;
    } else {
      const ShownName label = NameOfOutput(name);
      column.words = WordsOf(label.label, ' ');
      column.unit = label.unit;
    }
    for (const std::string& cell : CellsOf(table, i)) {
      column.texts.push_back(Rounded(cell));
    }
    columns.Add(std::move(column));
    ++shown;
  }
  const std::size_t count = columns.CountWithin(width);
  std::string text;
  for (const std::string& line : columns.Lines(count)) {
    text += line + "\n";
  }
  if (count < shown) {
    text += fmt::format("  and {} more column{}\n", shown - count, shown - count == 1 ? "" : "s");
  }
  return text;
}

/// Formats a table with the minimum, median and maximum of each output. Outputs without a number in
/// any row are omitted.
std::string ExtremesText(const TextTable& table, std::size_t status, std::size_t width) {
  constexpr std::size_t kNumber = 10;
  struct Line {
    std::string name;
    std::vector<double> values;  ///< smallest, median, largest
    std::size_t count;
  };
  std::vector<Line> lines;
  std::size_t longest = 0;
  for (std::size_t i = status + 1; i < table.columns().size(); ++i) {
    std::vector<double> numbers;
    for (const std::string& cell : CellsOf(table, i)) {
      if (const std::optional<double> number = CellNumber(cell)) {
        numbers.push_back(*number);
      }
    }
    if (numbers.empty() || table.columns()[i] == "runs") {
      continue;
    }
    const ShownName name = NameOfOutput(table.columns()[i]);
    const std::size_t count = numbers.size();
    lines.push_back({name.label + (name.unit.empty() ? "" : " [" + name.unit + "]"),
                     Quantiles(std::move(numbers), {0.0, 0.5, 1.0}), count});
    longest = std::max(longest, lines.back().name.size());
  }
  if (lines.empty()) {
    return "";
  }
  longest = std::min(longest, width > 4 * (kNumber + 1) + 22 ? width - 4 * (kNumber + 1) - 2 : 20);
  std::string text =
      fmt::format("  {:<{}} {:>{w}} {:>{w}} {:>{w}} {:>{w}}\n", "", longest, "smallest", "median",
                  "largest", "of rows", fmt::arg("w", kNumber));
  for (const Line& line : lines) {
    text += fmt::format("  {:<{}} {:>{w}.4g} {:>{w}.4g} {:>{w}.4g} {:>{w}}\n", line.name, longest,
                        line.values[0], line.values[1], line.values[2], line.count,
                        fmt::arg("w", kNumber));
  }
  return text;
}

}  // namespace

std::string SweepTableText(const TextTable& table, std::size_t width) {
  const auto at = std::find(table.columns().begin(), table.columns().end(), "status");
  const auto status = static_cast<std::size_t>(at - table.columns().begin());
  if (table.rows().empty() || at == table.columns().end()) {
    return "";
  }
  return table.rows().size() <= kMaxRowsInFull ? RowsText(table, status, width)
                                               : ExtremesText(table, status, width);
}

}  // namespace trackbed::cli
