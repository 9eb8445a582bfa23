#include "trackbed/core/text_table.h"

#include <csv.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

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

/// Collects what libcsv calls back with.
struct TextReader {
  std::string file;
  std::optional<TextTable> table{};
  std::vector<std::string> cells{};
  int line = 1;     // where the row begins
  int endings = 0;  // of lines, in its quoted cells
  std::vector<Problem> problems{};

  void AddError(std::string message) {
    problems.push_back({.file = file, .line = line, .message = std::move(message)});
  }

  void Cell(std::string cell) {
    endings += static_cast<int>(std::count(cell.begin(), cell.end(), '\n'));
    cells.push_back(std::move(cell));
  }

  /// `ending` is the character that ended the row, or -1 at the end of the file.
  void EndOfRow(int ending) {
    if (cells.empty()) {
      // an empty line
    } else if (!table) {
      for (auto name = cells.begin(); name != cells.end(); ++name) {
        if (name->empty()) {
          AddError(fmt::format("cell {}: the column has no name", name - cells.begin() + 1));
        } else if (std::find(cells.begin(), name, *name) != name) {
          AddError(fmt::format("repeated column '{}'", *name));
        }
      }
      table.emplace(cells);
    } else if (cells.size() != table->columns().size()) {
      AddError(fmt::format("{} {}, the header has {}", cells.size(),
                           cells.size() == 1 ? "cell" : "cells", table->columns().size()));
    } else {
      table->AddRow(std::move(cells));
    }
    cells.clear();
    // A carriage return before it ends the row, not the line.
    line += std::exchange(endings, 0) + (ending == '\n' ? 1 : 0);
  }
};

}  // namespace

std::string ShortestText(double number) {
  return fmt::format("{}", number + 0.0);  // `+ 0.0` turns a negative zero into zero
}

std::pair<std::string, std::string> FormatDistinct(double first, double second) {
  std::pair<std::string, std::string> texts;
  constexpr int kAllDigits = 17;  // of a double: no two share them
  for (int digits = 4; digits <= kAllDigits; ++digits) {
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
  std::string csv;
  AddLine(columns_, csv);
  for (const std::vector<std::string>& row : rows_) {
    AddLine(row, csv);
  }
  return csv;
}

TextTable ReadTextCsv(const std::filesystem::path& file) {
  const std::string content = ReadFile(file);
  std::string_view text = content;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  TextReader reader{.file = file.string()};
  csv_parser parser{};
  TRACKBED_CHECK(csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL) == 0,
                 "libcsv did not start");
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> guard(&parser, csv_free);
  const auto cell = [](void* data, std::size_t size, void* self) {
    static_cast<TextReader*>(self)->Cell({static_cast<const char*>(data), size});
  };
  const auto row = [](int ending, void* self) { static_cast<TextReader*>(self)->EndOfRow(ending); };
  const std::size_t parsed = csv_parse(&parser, text.data(), text.size(), cell, row, &reader);
  if (parsed != text.size() || csv_fini(&parser, cell, row, &reader) != 0) {
    reader.AddError(csv_strerror(csv_error(&parser)));
  }
  if (!reader.table && reader.problems.empty()) {
    reader.AddError("empty file; expected a header line of column names");
  }
  if (!reader.problems.empty()) {
    throw InputError(FirstProblems(std::move(reader.problems)));
  }
  return std::move(*reader.table);
}

}  // namespace trackbed
