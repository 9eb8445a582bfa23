#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Callback that receives each row of a CSV file. `cells` are the cells of the row, which the
/// callback may move from. `line` is the number (from 1) of the line on which the row begins.
using TakeCsvRow = std::function<void(std::vector<std::string>& cells, int line)>;

/// Callback that receives the names of a table's columns, which the callback may move from.
using TakeCsvNames = std::function<void(std::vector<std::string>& names, int line)>;

/// Value of CsvLimits::delimiter that stands for the most frequent of comma, semicolon and tab in
/// the first line that is neither empty nor a comment. If the first line contains no comma,
/// semicolon or tab, blanks (kBlanks) can be the delimiter. Blanks are the delimiter if they
/// separate numbers in the first line, or names in the first line and equally many numbers in the
/// next line.
inline constexpr char kFindDelimiter = '\0';

/// Value of CsvLimits::delimiter for cells that are separated by any number of spaces and tabs.
inline constexpr char kBlanks = ' ';

/// The delimiter of a CSV file, and limits on the size of the file.
struct CsvLimits {
  std::size_t max_cells = 50'000'000;
  std::size_t max_bytes = kMaxFileBytes;
  char delimiter = ',';
  /// Whether lines that begin with '#' are comments. The text of a comment, with the '#', is passed
  /// on as a row of a single cell, whatever characters it contains.
  bool comments = false;
  /// Whether ReadCsvTable calls the columns of a table without names "1", "2", ... If false, a
  /// table whose columns have no names is a problem.
  bool numbers_columns = false;
};

/// Reads a CSV file (RFC 4180, with libcsv) and calls `take` for each row, beginning with the
/// header. Skips empty lines, spaces around cells and a byte order mark. The file is read as a
/// stream, so large files need little memory.
///
/// If the file is not valid CSV, adds a problem to `problems` and stops reading. The limits on a
/// CSV file are 4096 cells per row, 64 KiB per cell and `max_cells` cells in all rows, so that
/// memory is bounded for a file of any length. Also adds a problem if the CSV file has no rows.
/// Throws RunError in the same cases as ReadBlocks.
void ReadCsvRows(const std::filesystem::path& file, const CsvLimits& limits, ProblemList& problems,
                 const TakeCsvRow& take);

/// Reads a table with named columns from a CSV file of another program. Lines that begin with '#'
/// are comments. The names of the columns are in the first line that is not a comment or, if this
/// line consists of numbers, in the last comment with equally many cells before this line. The
/// cells of a comment are separated by the delimiter of the file.
///
/// Calls `take_names` once, and then `take` for each row. Drops empty cells at the end of a row
/// that exceed the number of names, because some programs end each line with a delimiter. Returns
/// false, without adding a problem, if the file contains only comments. Adds a problem if there are
/// no column names, unless limits.numbers_columns is true. All other problems and errors are the
/// same as for ReadCsvRows.
bool ReadCsvTable(const std::filesystem::path& file, CsvLimits limits, ProblemList& problems,
                  const TakeCsvNames& take_names, const TakeCsvRow& take);

}  // namespace trackbed
