#include "trackbed/core/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

namespace trackbed {

std::string CsvLine(const std::vector<std::string>& cells) {
  std::string csv;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    csv += i == 0 ? "" : ",";
    // Quote an empty cell that is the only cell of its row, because CSV readers skip empty lines.
    if (cells[i].find_first_of(",\"\r\n") == std::string::npos &&
        !(cells.size() == 1 && cells[i].empty())) {
      csv += cells[i];
      continue;
    }
    csv += '"';
    for (const char c : cells[i]) {
      csv += c == '"' ? "\"\"" : std::string(1, c);
    }
    csv += '"';
  }
  csv += '\n';
  return csv;
}

std::optional<double> CellNumber(const std::string& cell) {
  double value = 0.0;
  const char* const end = cell.data() + cell.size();
  const auto [read_to, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc{} && read_to == end && std::isfinite(value) ? std::optional(value)
                                                                        : std::nullopt;
}

std::string ShortestText(double number) {
  return fmt::format("{}", number + 0.0);  // adding 0.0 to -0.0 gives 0.0
}

std::pair<std::string, std::string> FormatDistinct(double first, double second) {
  std::pair<std::string, std::string> texts;
  // Number of significant digits with which every double can be written and read back exactly.
  constexpr int kRoundTripDigits = 17;
  for (int digits = 4; digits <= kRoundTripDigits; ++digits) {
    texts = {fmt::format("{:.{}g}", first, digits), fmt::format("{:.{}g}", second, digits)};
    if (first == second || texts.first != texts.second) {
      break;
    }
  }
  return texts;
}

TextTable::TextTable(std::vector<std::string> columns) : columns_(std::move(columns)) {
  TRACKBED_CHECK(!columns_.empty(), "a table needs columns");
}

void TextTable::AddRow(std::vector<std::string> row) {
  TRACKBED_CHECK(row.size() == columns_.size(), "a row of {} cells in a table of {} columns",
                 row.size(), columns_.size());
  rows_.push_back(std::move(row));
}

std::string TextTable::ToCsv() const {
  std::string csv = CsvLine(columns_);
  for (const std::vector<std::string>& row : rows_) {
    csv += CsvLine(row);
  }
  return csv;
}

TextTable ReadTextCsv(const std::filesystem::path& file) {
  constexpr std::size_t kMaxCells = 10'000'000;  // each cell takes at least 32 bytes of memory
  ProblemList problems;
  std::optional<TextTable> table;
  ReadCsvRows(
      file, {.max_cells = kMaxCells}, problems, [&](std::vector<std::string>& cells, int line) {
        const auto add_error = [&](std::string message) {
          problems.Add({.file = file.string(), .line = line, .message = std::move(message)});
        };
        if (!table) {
          for (auto name = cells.begin(); name != cells.end(); ++name) {
            if (name->empty()) {
              add_error(fmt::format("cell {}: the column has no name", name - cells.begin() + 1));
            } else if (std::find(cells.begin(), name, *name) != name) {
              add_error(fmt::format("repeated column '{}'", *name));
            }
          }
          table.emplace(cells);
        } else if (cells.size() != table->columns().size()) {
          add_error(fmt::format("{} {}, the header has {}", cells.size(),
                                cells.size() == 1 ? "cell" : "cells", table->columns().size()));
        } else {
          table->AddRow(std::move(cells));
        }
      });
  problems.ThrowIfAny();
  return *std::move(table);
}

}  // namespace trackbed
