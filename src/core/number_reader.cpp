#include "src/core/number_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "src/core/csv_number.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/timestamp.h"

namespace trackbed {
namespace {

/// Returns a message that explains why a cell of a table is not a number.
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

std::string CountCells(const std::vector<std::string>& cells) {
  return fmt::format("{} {}", cells.size(), cells.size() == 1 ? "cell" : "cells");
}

}  // namespace

void NumberReader::AddError(std::string key, std::string message) {
  problems.Add({file, line, 0, std::move(key), std::move(message)});
}

void NumberReader::AddCellError(std::size_t cell, std::string message) {
  const std::string& column = header[cell];
  const std::string name = column.empty() ? "" : fmt::format(" ({})", column);
  AddError(fmt::format("cell {}{}", cell + 1, name), std::move(message));
}

void NumberReader::TakeRow() {
  if (header.empty()) {
    Header();
  } else if (cells.size() < header.size()) {
    AddCellError(cells.size(),
                 fmt::format("missing; {}, the header has {}", CountCells(cells), header.size()));
  } else if (cells.size() > header.size()) {
    AddError("", fmt::format("{}, the header has {}", CountCells(cells), header.size()));
  } else if (table) {
    Row();
  }
}

void NumberReader::Take(std::vector<std::string>& row, int row_line) {
  cells.swap(row);
  line = row_line;
  TakeRow();
  cells.swap(row);
}

void NumberReader::Header() {
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

void NumberReader::Row() {
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
      const std::optional<double> time = TimestampOrTimeOfDay(cell);
      value = time.value_or(0.0);
      if (!time) {
        AddCellError(i, fmt::format("'{}' is neither a number nor a timestamp such as "
                                    "2024-05-01T12:30:00Z or 12:30:00.5",
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

}  // namespace trackbed
