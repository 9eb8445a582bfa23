#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

namespace trackbed {

/// Specifies which columns of a CSV file are read and which cells are valid.
struct ColumnSelection {
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

/// Converts rows of a CSV file to a table of numbers.
struct NumberReader {
  std::string file;
  ColumnSelection selection;
  // Callback that receives the rows of the file, if the file has all needed columns. Without this
  // callback, the rows are added to the table.
  std::function<void(const std::vector<double>& numbers, int line)> take{};
  std::optional<Table> table{};
  std::vector<int> lines{};           // Line of the file from which each row of the table was read.
  std::vector<std::string> header{};  // Names of all columns of the file, in the order of the file.
  std::vector<std::size_t> taken{};   // Index in `header` of each column of the table.
  std::vector<std::string> cells{};   // Cells of the current row.
  int line = 1;                       // Line of the file on which the current row begins.
  bool has_needed = true;             // Whether the file has all needed columns.
  ProblemList problems{};

  /// Records an error message about the current line.
  void AddError(std::string key, std::string message);

  /// Records an error message about a cell of the current row. The error message states the cell by
  /// its number in the row, counted from 1, and its column name, because libcsv reports no
  /// character positions.
  void AddCellError(std::size_t cell, std::string message);

  /// Reads the names of the columns from the first row, and the numbers from all other rows.
  void TakeRow();

  /// Calls TakeRow for the given cells, which stay unchanged.
  void Take(std::vector<std::string>& row, int row_line);

 private:
  void Header();
  void Row();
};

}  // namespace trackbed
