#include "trackbed/core/text_table.h"

#include <fmt/format.h>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

void AddLine(const std::vector<std::string>& cells, std::string& csv) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    csv += i == 0 ? "" : ",";
    // A line of one empty cell would be an empty line, which readers skip.
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
}

}  // namespace

std::string ShortestText(double number) {
  return fmt::format("{}", number + 0.0);  // `+ 0.0` turns a negative zero into zero
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
  std::string csv;
  AddLine(columns_, csv);
  for (const std::vector<std::string>& row : rows_) {
    AddLine(row, csv);
  }
  return csv;
}

}  // namespace trackbed
