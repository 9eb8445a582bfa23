#include "trackbed/core/table.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "src/core/number_reader.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

// Tables of numbers, read from and written to CSV files.
// 1. ReadThrough passes the rows of a file to a NumberReader, which selects columns by the names in
//    the header.
// 2. The NumberReader converts each cell by std::from_chars, which does not depend on the locale.
// 3. Problems in a CSV file are collected with line, column and cell, up to a maximum number, and
//    thrown together.
// 4. ToCsv writes each number with the fewest digits from which the same double can be read.
namespace trackbed {
namespace {

/// Reads a whole CSV file through `reader`. Throws InputError if any part of the file cannot be
/// read.
void ReadThrough(const std::filesystem::path& file, const CsvLimits& limits, NumberReader& reader) {
  ReadCsvRows(file, limits, reader.problems,
              [&](std::vector<std::string>& cells, int line) { reader.Take(cells, line); });
  reader.problems.ThrowIfAny();
}

NumberReader ReadThrough(const std::filesystem::path& file, ColumnSelection selection) {
  NumberReader reader{.file = file.string(), .selection = std::move(selection)};
  ReadThrough(file, {}, reader);
  return reader;
}

}  // namespace

void ProblemList::Add(Problem problem) {
  constexpr std::size_t kMaxProblems = 20;
  const auto after =
      std::upper_bound(problems_.begin(), problems_.end(), problem.line,
                       [](int line, const Problem& other) { return line < other.line; });
  problems_.insert(after, std::move(problem));
  if (problems_.size() > kMaxProblems) {
    problems_.pop_back();
    ++omitted_;
  }
}

void ProblemList::ThrowIfAny() const {
  if (problems_.empty()) {
    return;
  }
  std::vector<Problem> problems = problems_;
  if (omitted_ > 0) {
    problems.push_back(
        {.file = problems.back().file, .message = fmt::format("and {} more problems", omitted_)});
  }
  throw InputError(std::move(problems));
}

Table::Table(std::vector<std::string> columns) : columns_(std::move(columns)) {
  TRACKBED_CHECK(!columns_.empty(), "a table needs columns");
}

void Table::AddRow(const std::vector<double>& row) {
  TRACKBED_CHECK(row.size() == columns_.size(), "a row of {} cells in a table of {} columns",
                 row.size(), columns_.size());
  cells_.insert(cells_.end(), row.begin(), row.end());
}

int Table::Find(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

std::vector<double> Table::Column(std::string_view column) const {
  const int index = Find(column);
  if (index < 0) {
    throw InputError(Problem{.key = std::string(column), .message = "no such column"});
  }
  std::vector<double> values(rows());
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] = at(row, static_cast<std::size_t>(index));
  }
  return values;
}

std::string Table::ToCsv() const {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "{}\n", fmt::join(columns_, ","));
  const std::size_t width = columns_.size();
  for (std::size_t row = 0; row < rows(); ++row) {
    for (std::size_t column = 0; column < width; ++column) {
      // Add 0.0 to convert a negative zero to zero, because the sign of a zero has no meaning in a
      // log.
      fmt::format_to(fmt::appender(out), FMT_COMPILE("{}"), at(row, column) + 0.0);
      out.push_back(column + 1 < width ? ',' : '\n');
    }
  }
  return fmt::to_string(out);
}

Table ReadCsv(const std::filesystem::path& file) {
  return std::move(*ReadThrough(file, {}).table);
}

CsvExcerpt ReadCsvExcerpt(const std::filesystem::path& file, std::vector<std::string> needed,
                          std::vector<std::string> optional) {
  TRACKBED_CHECK(!needed.empty(), "an excerpt needs columns");
  NumberReader reader = ReadThrough(
      file,
      {.all = false, .needed = std::move(needed), .optional = std::move(optional), .finite = true});
  return {std::move(*reader.table), std::move(reader.lines)};
}

}  // namespace trackbed
