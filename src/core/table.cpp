#include "trackbed/core/table.h"

#include <csv.h>
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

/// Which columns are read.
struct Selection {
  bool all = true;
  std::vector<std::string> needed{};    // otherwise these, which must be there,
  std::vector<std::string> optional{};  // and these, which may
  bool finite = false;                  // whether cells must be

  [[nodiscard]] bool Takes(const std::string& column) const {
    return all || std::find(needed.begin(), needed.end(), column) != needed.end() ||
           std::find(optional.begin(), optional.end(), column) != optional.end();
  }
};

/// Collects what libcsv calls back with.
struct Reader {
  std::string file;
  Selection selection;
  std::optional<Table> table{};
  std::vector<int> lines{};           // of the table's rows
  std::vector<std::string> header{};  // every name in the file
  std::vector<std::size_t> taken{};   // indices into it, of the table's columns
  std::vector<std::string> cells{};
  int line = 1;
  std::vector<Problem> problems{};

  void AddError(std::string key, std::string message) {
    problems.push_back({file, line, 0, std::move(key), std::move(message)});
  }

  /// libcsv counts no characters, so a cell is placed by its number, from 1, and its column's name.
  void AddCellError(std::size_t cell, std::string message) {
    const std::string& column = header[cell];
    const std::string name = column.empty() ? "" : fmt::format(" ({})", column);
    AddError(fmt::format("cell {}{}", cell + 1, name), std::move(message));
  }

  /// `ending` is the character that ended the row, or -1 at the end of the file.
  void EndOfRow(int ending) {
    if (cells.empty()) {
      // an empty line
    } else if (header.empty()) {
      Header();
    } else if (cells.size() < header.size()) {
      AddCellError(cells.size(),
                   fmt::format("missing; {}, the header has {}", CellCount(), header.size()));
    } else if (cells.size() > header.size()) {
      AddError("", fmt::format("{}, the header has {}", CellCount(), header.size()));
    } else if (table) {
      Row();
    }
    cells.clear();
    line += ending == '\n' ? 1 : 0;  // a carriage return before it ends the row, not the line
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
      double value = 0.0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size()) {
        AddCellError(i, fmt::format("'{}' is not a number", cell));
      } else if (selection.finite && !std::isfinite(value)) {
        AddCellError(i, fmt::format("'{}' is not a finite number", cell));
      }
      row.push_back(value);
    }
    table->AddRow(row);
    lines.push_back(line);
  }
};

/// The whole file; InputError unless everything in it can be read.
Reader ReadThrough(const std::filesystem::path& file, Selection selection) {
  const std::string content = ReadFile(file);
  std::string_view text = content;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  Reader reader{.file = file.string(), .selection = std::move(selection)};

  csv_parser parser{};
  TRACKBED_CHECK(csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL) == 0,
                 "libcsv did not start");
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> guard(&parser, csv_free);
  const auto cell = [](void* data, std::size_t size, void* self) {
    static_cast<Reader*>(self)->cells.emplace_back(static_cast<const char*>(data), size);
  };
  const auto row = [](int ending, void* self) { static_cast<Reader*>(self)->EndOfRow(ending); };
  const std::size_t parsed = csv_parse(&parser, text.data(), text.size(), cell, row, &reader);
  if (parsed != text.size() || csv_fini(&parser, cell, row, &reader) != 0) {
    reader.AddError("", csv_strerror(csv_error(&parser)));
  }
  if (reader.header.empty() && reader.problems.empty()) {
    reader.AddError("", "empty file; expected a header line of column names");
  }
  if (!reader.problems.empty()) {
    throw InputError(FirstProblems(std::move(reader.problems)));
  }
  return reader;
}

}  // namespace

std::vector<Problem> FirstProblems(std::vector<Problem> problems) {
  constexpr std::size_t kMaxProblems = 20;
  if (problems.size() > kMaxProblems) {
    const std::string more = fmt::format("and {} more problems", problems.size() - kMaxProblems);
    problems.resize(kMaxProblems);
    problems.push_back({.file = problems.back().file, .message = more});
  }
  return problems;
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
      // `+ 0.0` turns a negative zero into zero: the sign of nothing is noise in a log.
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

}  // namespace trackbed
