#include "src/core/csv_head.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "src/core/csv_number.h"
#include "src/core/vbo.h"
#include "trackbed/core/file.h"
#include "trackbed/core/text_table.h"

// Finds the preamble and the units of a CSV table.
// 1. Splits the first lines of the file at the delimiter, outside of quotes.
// 2. Finds the first row of numbers, and the lines directly above it that have the same number of
//    cells.
// 3. The topmost line with as many cells as the first row of numbers contains the column names. The
//    lines between the column names and the numbers contain units. A first row that numbers the
//    columns, as the loggers of AiM write it behind the units, is no data.
namespace trackbed {
namespace {

constexpr std::size_t kMaxLines = 300;

struct Line {
  int number;
  std::vector<std::string> cells;
};

std::string Trimmed(std::string_view cell) {
  constexpr std::string_view kAround = " \t\r\"";
  cell.remove_prefix(std::min(cell.find_first_not_of(kAround), cell.size()));
  return std::string(cell.substr(0, cell.find_last_not_of(kAround) + 1));
}

std::vector<std::string> Split(std::string_view line, char delimiter) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    if (at == line.size() || (line[at] == delimiter && !quoted)) {
      cells.push_back(Trimmed(line.substr(begin, at - begin)));
      begin = at + 1;
    } else if (line[at] == '"') {
      quoted = !quoted;
    }
  }
  return cells;
}

/// Returns the complete lines in the first block of a file that are neither empty nor comments.
std::vector<Line> FirstLines(std::string_view begin, char delimiter) {
  std::vector<Line> lines;
  for (int number = 1; lines.size() < kMaxLines; ++number) {
    const std::size_t end = begin.find('\n');
    if (end == std::string_view::npos) {
      break;
    }
    const std::string_view text = begin.substr(0, end);
    begin.remove_prefix(end + 1);
    if (text.find_first_not_of(" \t\r") != std::string_view::npos && !text.starts_with('#')) {
      lines.push_back({number, Split(text, delimiter)});
    }
  }
  return lines;
}

/// Rewrites the numbers of lines (NormalizeNumber). Returns whether the numbers have decimal
/// commas.
bool Normalize(std::vector<Line>& lines, char delimiter) {
  std::vector<std::vector<std::string>> rows;
  for (const Line& line : lines) {
    rows.push_back(line.cells);
  }
  const bool has_decimal_commas = delimiter != ',' && HasDecimalCommas(rows);
  for (Line& line : lines) {
    for (std::string& cell : line.cells) {
      NormalizeNumber(cell, has_decimal_commas);
    }
  }
  return has_decimal_commas;
}

std::size_t Numbers(const Line& line) {
  return static_cast<std::size_t>(std::count_if(line.cells.begin(), line.cells.end(),
                                                [](const auto& c) { return CellNumber(c); }));
}

std::size_t Filled(const Line& line) {
  return static_cast<std::size_t>(std::count_if(line.cells.begin(), line.cells.end(),
                                                [](const auto& c) { return !c.empty(); }));
}

/// Returns the number of cells of a line up to the last cell that is not empty.
std::size_t Width(const Line& line) {
  const auto last = std::find_if(line.cells.rbegin(), line.cells.rend(),
                                 [](const std::string& cell) { return !cell.empty(); });
  return static_cast<std::size_t>(line.cells.rend() - last);
}

bool AreAlike(const Line& a, const Line& b) {
  return a.cells.size() == b.cells.size() || Width(a) == Width(b);
}

bool IsData(const Line& line) {
  const std::size_t numbers = Numbers(line);
  return numbers >= 2 && 2 * numbers >= Filled(line);
}

/// Whether the cells of a line are 1, 2, 3, and so on.
bool NumbersColumns(const Line& line) {
  for (std::size_t i = 0; i < line.cells.size(); ++i) {
    if (CellNumber(line.cells[i]) != static_cast<double>(i + 1)) {
      return false;
    }
  }
  return true;
}

/// Returns a unit without brackets: "m" for "[m]".
std::string WithoutBrackets(const std::string& unit) {
  return unit.size() > 2 && unit.front() == '[' && unit.back() == ']'
             ? unit.substr(1, unit.size() - 2)
             : unit;
}

bool IsUnit(const std::string& cell) {
  constexpr std::array kUnits{"s",   "ms",    "m",   "cm",  "mm",  "km",    "ft",     "m/s",
                              "mps", "km/h",  "kmh", "kph", "mph", "knots", "rad",    "deg",
                              "g",   "G",     "gee", "rpm", "%",   "rad/s", "deg/s",  "\xC2\xB0",
                              "bar", "m/s^2", "kPa", "psi", "C",   "m/s2",  "degrees"};
  return std::find(kUnits.begin(), kUnits.end(), cell) != kUnits.end();
}

/// Returns the head of a CSV table (preamble, names, units), or nullopt if the table has neither
/// preamble nor units.
std::optional<CsvHead> HeadWith(std::string_view begin, char delimiter) {
  std::vector<Line> lines = FirstLines(begin, delimiter);
  const bool has_decimal_commas = Normalize(lines, delimiter);
  std::size_t data = 0;
  while (data + 1 < lines.size() && !(IsData(lines[data]) && IsData(lines[data + 1]) &&
                                      AreAlike(lines[data], lines[data + 1]))) {
    ++data;
  }
  if (data + 1 >= lines.size()) {
    return std::nullopt;
  }
  std::size_t names = data;
  while (names > 0 && Numbers(lines[names - 1]) == 0 && AreAlike(lines[names - 1], lines[data])) {
    --names;
  }
  const bool has_preamble = names > 0 && !AreAlike(lines.front(), lines[data]);
  if (names == data || (names > 0 && !has_preamble)) {
    return std::nullopt;
  }
  CsvHead head{.delimiter = delimiter, .has_decimal_commas = has_decimal_commas};
  if (has_preamble) {
    head.preamble_lines = lines[names].number - 1;
  }
  if (data > names + 1) {
    std::vector<std::string> units = lines[names + 1].cells;
    std::transform(units.begin(), units.end(), units.begin(), WithoutBrackets);
    if (std::none_of(units.begin(), units.end(), IsUnit)) {
      return has_preamble ? std::optional(head) : std::nullopt;
    }
    head.units = std::move(units);
    head.first_row = lines[has_preamble && NumbersColumns(lines[data]) ? data + 1 : data].number;
  }
  return has_preamble || !head.units.empty() ? std::optional(head) : std::nullopt;
}

}  // namespace

CsvHead FindCsvHead(const std::filesystem::path& file, char delimiter) {
  std::string begin;
  ReadBlocks(file, [&](std::string_view block) {
    begin = block;
    return false;
  });
  std::string_view text = begin;
  if (constexpr std::string_view kMark = "\xEF\xBB\xBF"; text.starts_with(kMark)) {
    text.remove_prefix(kMark.size());
  }
  if (const std::optional<CsvHead> head = FindVboHead(text)) {
    return *head;
  }
  for (const char candidate : {delimiter, ',', ';', '\t'}) {
    if (const std::optional<CsvHead> head = HeadWith(text, candidate)) {
      return *head;
    }
  }
  std::vector<Line> lines = FirstLines(text, delimiter);
  return {.delimiter = delimiter, .has_decimal_commas = Normalize(lines, delimiter)};
}

std::string NameWithUnit(const std::string& name, const std::string& unit) {
  const bool has_unit = name.ends_with(']') || name.ends_with(')');
  return unit.empty() || unit == "#" || has_unit ? name : name + " [" + unit + "]";
}

}  // namespace trackbed
