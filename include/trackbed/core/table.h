#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// A table of numbers with named columns: the format of a run's CSV files. The header line has the
/// column names, which include units ("speed_mps"). Each further line has the numbers of one row.
///
/// Guarantees: numbers are written in the shortest form that reads back to the same double; a
/// negative zero is written as 0. ReadCsv therefore restores the table that ToCsv wrote. The table
/// cannot hold text.
class Table {
 public:
  explicit Table(std::vector<std::string> columns);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return cells_.size() / columns_.size(); }

  /// Appends a row; InternalError unless it has one number per column.
  void AddRow(const std::vector<double>& row);

  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_.size() + column];
  }

  /// The index of a column; -1 if the table has no such column.
  [[nodiscard]] int Find(std::string_view column) const;
  /// Returns a whole column by its name. InputError naming the column if it is missing.
  [[nodiscard]] std::vector<double> Column(std::string_view column) const;

  [[nodiscard]] std::string ToCsv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> cells_;  // All cells, row by row.
};

/// Reads a CSV file with a header line (RFC 4180 through libcsv). Skips empty lines, spaces around
/// cells and a byte order mark.
///
/// InputError with file and line for a cell that is not a number and for a row of the wrong length.
/// For a repeated or empty column name, the message also has the number of the cell. InputError for
/// an empty file, and for more than 4096 columns, 5e7 cells or 64 KiB in a cell. Lists the first
/// twenty problems. Throws the RunErrors of ReadFile.
Table ReadCsv(const std::filesystem::path& file);

/// Collects the problems of a file: the first twenty in order of lines, and the number of further
/// ones.
class ProblemList {
 public:
  void Add(Problem problem);
  [[nodiscard]] bool empty() const { return problems_.empty(); }
  /// Throws an InputError with the problems, in order of lines. Does nothing if there are no
  /// problems.
  void ThrowIfAny() const;

 private:
  std::vector<Problem> problems_;  // Problems in order of lines.
  std::size_t omitted_ = 0;
};

/// Selected columns of a CSV file from another program.
struct CsvExcerpt {
  Table table;             ///< Requested columns that the file has, in file order.
  std::vector<int> lines;  ///< Line numbers of the rows in the file, from 1.
};

/// Reads the columns `needed`, at least one, and those of `optional` that the file has. Ignores
/// other columns. Throws the InputErrors of ReadCsv. InputError for a missing needed column (with
/// the nearest spelling) and for a cell that is not finite.
CsvExcerpt ReadCsvExcerpt(const std::filesystem::path& file, std::vector<std::string> needed,
                          std::vector<std::string> optional = {});

/// Reads columns of a CSV file of any length as a stream. Calls `take` for each row with the
/// numbers of `columns`, in that order, and the line on which the row begins. `columns` must not
/// repeat a name. Empty cells are NaN. Values that are not finite are passed on, and there is no
/// limit on the number of cells. For other problems, throws the InputErrors of ReadCsvExcerpt,
/// after the last row. Throws the RunErrors of ReadFile.
void ReadCsvNumbers(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter,
                    const std::function<void(const std::vector<double>& numbers, int line)>& take);

}  // namespace trackbed
