#include "trackbed/core/table.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/timestamp.h"

// Tables of numbers, read from and written to CSV files.
// 1. ReadThrough passes the rows of a file to a Reader, which selects columns by the names in the
//    header.
// 2. The Reader converts each cell by std::from_chars, which does not depend on the locale.
// 3. Problems are collected with line, column and cell, up to a maximum number, and thrown
//    together.
// 4. ToCsv writes each number in the shortest form from which the same double can be read.
namespace trackbed {
namespace {

/// Specifies which columns of a CSV file are read and which cells are valid.
struct Selection {
  bool all = true;
  std::vector<std::string> needed{};    // Columns that the table must have, if `all` is false.
  std::vector<std::string> optional{};  // Columns that the table may have, if `all` is false.
  bool finite = false;                  // Whether infinite and NaN cells are errors.
  std::string timestamps{};             // Column whose cells may be timestamps.
  bool empty = false;                   // Whether cells may be empty; an empty cell is read as NaN.

  [[nodiscard]] bool Takes(const std::string& column) const {
    return all || std::find(needed.begin(), needed.end(), column) != needed.end() ||
           std::find(optional.begin(), optional.end(), column) != optional.end();
  }
};

/// Explains why a cell is not a number.
std::string NotANumber(const std::string& cell) {
  std::string pointed = cell;
  const std::size_t comma = pointed.find(',');
  if (comma != std::string::npos) {
    pointed[comma] = '.';
    if (CellNumber(pointed)) {
      return fmt::format("'{}' has a decimal comma; write {}", cell, pointed);
    }
  }
  return fmt::format("'{}' is not a number", cell);
}

/// Converts rows of text to a table of numbers.
struct Reader {
  std::string file;
  Selection selection;
  // Receives the rows, if all needed columns are there. If `take` is empty, the rows are added to
  // the table.
  std::function<void(const std::vector<double>& numbers, int line)> take{};
  std::optional<Table> table{};
  std::vector<int> lines{};           // Line of the file from which each row of the table was read.
  std::vector<std::string> header{};  // Names of all columns of the file, in the order of the file.
  std::vector<std::size_t> taken{};   // For each column of the table, its index in `header`.
  std::vector<std::string> cells{};   // Cells of the current row.
  int line = 1;                       // Line of the file on which the current row begins.
  bool has_needed = true;             // Whether the file has all needed columns.
  ProblemList problems{};

  void AddError(std::string key, std::string message) {
    problems.Add({file, line, 0, std::move(key), std::move(message)});
  }

  /// Adds a problem of a cell. The error message contains the number of the cell in its row,
  /// counted from 1, and the name of the column, because libcsv does not report the position of
  /// characters.
  void AddCellError(std::size_t cell, std::string message) {
    const std::string& column = header[cell];
    const std::string name = column.empty() ? "" : fmt::format(" ({})", column);
    AddError(fmt::format("cell {}{}", cell + 1, name), std::move(message));
  }

  void TakeRow() {
    if (header.empty()) {
      Header();
    } else if (cells.size() < header.size()) {
      AddCellError(cells.size(),
                   fmt::format("missing; {}, the header has {}", CellCount(), header.size()));
    } else if (cells.size() > header.size()) {
      AddError("", fmt::format("{}, the header has {}", CellCount(), header.size()));
    } else if (table) {
      Row();
    }
  }

  [[nodiscard]] std::string CellCount() const {
    return fmt::format("{} {}", cells.size(), cells.size() == 1 ? "cell" : "cells");
  }

  void Header() {
    header = cells;
    std::vector<std::string> columns;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (!selection.Takes(header[i])) {
        continue;
      }
      if (header[i].empty()) {
        AddCellError(i, "the column has no name");
      } else if (std::find(columns.begin(), columns.end(), header[i]) != columns.end()) {
        AddCellError(i, "repeated column");
      }
      columns.push_back(header[i]);
      taken.push_back(i);
    }
    for (const std::string& name : selection.needed) {
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) {
        has_needed = false;
        const std::string near = NearestSpelling(name, header);
        AddError("", fmt::format("no column '{}'; {}", name,
                                 near.empty() ? fmt::format("columns: {}", fmt::join(header, ", "))
                                              : fmt::format("did you mean '{}'?", near)));
      }
    }
    if (!columns.empty()) {
      table.emplace(columns);
    }
  }

  void Row() {
    std::vector<double> row;
    row.reserve(taken.size());
    for (const std::size_t i : taken) {
      const std::string& cell = cells[i];
      if (cell.empty() && selection.empty) {
        row.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      double value = 0.0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      const bool is_number = error == std::errc{} && end == cell.data() + cell.size();
      if (!is_number && !selection.timestamps.empty() && header[i] == selection.timestamps) {
        const std::optional<double> time = TimestampSeconds(cell);
        value = time.value_or(0.0);
        if (!time) {
          AddCellError(i, fmt::format("'{}' is neither a number nor a timestamp such as "
                                      "2024-05-01T12:30:00Z",
                                      cell));
        }
      } else if (!is_number) {
        AddCellError(i, NotANumber(cell));
      } else if (selection.finite && !std::isfinite(value)) {
        AddCellError(i, fmt::format("'{}' is not a finite number", cell));
      }
      row.push_back(value);
    }
    if (take) {
      if (has_needed) {
        take(row, line);
      }
      return;
    }
    table->AddRow(row);
    lines.push_back(line);
  }
};

/// Reads a whole CSV file through `reader`. Throws InputError if any part of the file cannot be
/// read.
void ReadThrough(const std::filesystem::path& file, const CsvLimits& limits, Reader& reader) {
  ReadCsvRows(file, limits, reader.problems, [&](std::vector<std::string>& cells, int line) {
    reader.cells.swap(cells);
    reader.line = line;
    reader.TakeRow();
    reader.cells.swap(cells);
  });
  reader.problems.ThrowIfAny();
}

Reader ReadThrough(const std::filesystem::path& file, Selection selection) {
  Reader reader{.file = file.string(), .selection = std::move(selection)};
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
  Reader reader = ReadThrough(
      file,
      {.all = false, .needed = std::move(needed), .optional = std::move(optional), .finite = true});
  return {std::move(*reader.table), std::move(reader.lines)};
}

void ReadCsvNumbers(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter,
                    const std::function<void(const std::vector<double>&, int)>& take) {
  ReadCsvColumns(file, columns, delimiter, "", take);
}

void ReadCsvColumns(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter, const std::string& timestamps,
                    const std::function<void(const std::vector<double>&, int)>& take) {
  TRACKBED_CHECK(!columns.empty(), "numbers need columns");
  Reader reader{.file = file.string(),
                .selection = {.all = false,
                              .needed = columns,
                              .optional = {},
                              .timestamps = timestamps,
                              .empty = true}};
  std::vector<double> ordered(columns.size());
  // For each requested column, its index among the columns that were read.
  std::vector<std::size_t> place;
  reader.take = [&](const std::vector<double>& numbers, int line) {
    if (place.empty()) {
      for (const std::string& column : columns) {
        place.push_back(static_cast<std::size_t>(reader.table->Find(column)));
      }
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
      ordered[i] = numbers[place[i]];
    }
    take(ordered, line);
  };
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  const auto take_cells = [&](std::vector<std::string>& cells, int line) {
    reader.cells.swap(cells);
    reader.line = line;
    reader.TakeRow();
    reader.cells.swap(cells);
  };
  const bool has_names =
      ReadCsvTable(file, {.max_cells = kAny, .max_bytes = kAny, .delimiter = delimiter},
                   reader.problems, take_cells, take_cells);
  if (!has_names && reader.problems.empty()) {
    reader.AddError("", "no rows after the comments");
  }
  reader.problems.ThrowIfAny();
}

std::vector<std::string> ReadCsvNames(const std::filesystem::path& file, std::size_t& rows) {
  std::vector<std::string> found;
  ProblemList problems;
  rows = 0;
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  ReadCsvTable(
      file, {.max_cells = kAny, .max_bytes = kAny, .delimiter = kFindDelimiter}, problems,
      [&](std::vector<std::string>& names, int) { found = std::move(names); },
      [&](std::vector<std::string>&, int) { ++rows; });
  problems.ThrowIfAny();
  return found;
}

}  // namespace trackbed
