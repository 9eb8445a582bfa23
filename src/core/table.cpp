#include "trackbed/core/table.h"

#include <csv.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <memory>
#include <optional>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

/// Collects what libcsv calls back with.
struct Reader {
  std::string file;
  std::optional<Table> table;
  std::vector<std::string> cells;
  int line = 1;
  std::vector<Problem> problems;

  void Complain(std::string key, std::string message) {
    problems.push_back({file, line, 0, std::move(key), std::move(message)});
  }

  /// libcsv counts no characters, so a cell is placed by its number, from 1, and its column's name.
  void ComplainOfCell(std::size_t cell, const std::string& column, std::string message) {
    const std::string name = column.empty() ? "" : fmt::format(" ({})", column);
    Complain(fmt::format("cell {}{}", cell + 1, name), std::move(message));
  }

  /// `ending` is the character that ended the row, or -1 at the end of the file.
  void EndOfRow(int ending) {
    if (cells.empty()) {
      // an empty line
    } else if (!table) {
      Header();
    } else if (cells.size() != table->columns().size()) {
      Complain("", fmt::format("{} {} where the header has {}", cells.size(),
                               cells.size() == 1 ? "cell" : "cells", table->columns().size()));
    } else {
      Row();
    }
    cells.clear();
    line += ending == '\n' ? 1 : 0;  // a carriage return before it ends the row, not the line
  }

  void Header() {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto end = cells.begin() + static_cast<std::ptrdiff_t>(i);
      if (cells[i].empty() || std::find(cells.begin(), end, cells[i]) != end) {
        ComplainOfCell(i, cells[i],
                       cells[i].empty() ? "a column without a name" : "repeated column");
      }
    }
    table.emplace(cells);
  }

  void Row() {
    std::vector<double> row;
    row.reserve(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string& cell = cells[i];
      double value = 0.0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size()) {
        ComplainOfCell(i, table->columns()[i], fmt::format("'{}' is not a number", cell));
      }
      row.push_back(value);
    }
    table->AddRow(row);
  }
};

}  // namespace

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
      fmt::format_to(std::back_inserter(out), "{}{}", at(row, column) + 0.0,
                     column + 1 < width ? ',' : '\n');
    }
  }
  return fmt::to_string(out);
}

Table ReadCsv(const std::filesystem::path& file) {
  const std::string text = ReadFile(file);
  Reader reader;
  reader.file = file.string();

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
    reader.Complain("", csv_strerror(csv_error(&parser)));
  }
  if (!reader.table && reader.problems.empty()) {
    reader.Complain("", "empty file where a header line of column names is expected");
  }
  if (!reader.problems.empty()) {
    throw InputError(reader.problems);
  }
  return std::move(*reader.table);
}

}  // namespace trackbed
