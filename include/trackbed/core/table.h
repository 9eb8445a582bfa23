#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// A table of numbers with named columns, the format of a run's CSV files: one header line of names
/// that include their units ("speed_mps"), then one line of numbers per row.
///
/// Guarantees: numbers are written in the shortest form that reads back to the same double (a
/// negative zero as 0), so ToCsv and ReadCsv are inverse to each other. Does not hold text cells.
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

  /// Index of a column, or -1.
  [[nodiscard]] int Find(std::string_view column) const;
  /// A whole column by name; InputError naming a missing column.
  [[nodiscard]] std::vector<double> Column(std::string_view column) const;

  [[nodiscard]] std::string ToCsv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> cells_;  // row by row
};

/// Reads a CSV file with a header line (RFC 4180 through libcsv). InputError with file and line for
/// a cell that is not a number; for a repeated or empty column name (both with the number of the
/// cell); for a row of the wrong length; for an empty file; and for more than 4096 columns, 5e7
/// cells or 64 KiB in a cell. Lists the first twenty problems. RunError as ReadFile. Skips empty
/// lines, spaces around cells and a byte order mark.
Table ReadCsv(const std::filesystem::path& file);

/// The problems of a file: the first twenty by line, and the number of further ones.
class ProblemList {
 public:
  void Add(Problem problem);
  [[nodiscard]] bool empty() const { return problems_.empty(); }
  /// Throws an InputError with the problems, in the order of their lines; does nothing if there are
  /// none.
  void ThrowIfAny() const;

 private:
  std::vector<Problem> problems_;  // in the order of their lines
  std::size_t omitted_ = 0;
};

/// Selected columns of a CSV file from another program.
struct CsvExcerpt {
  Table table;             ///< the requested columns that the file has, in file order
  std::vector<int> lines;  ///< line numbers of the rows in the file, from 1
};

/// Reads the columns `needed`, at least one, and those of `optional` that are present; ignores
/// other columns. InputError as ReadCsv, and for a missing needed column (with the nearest
/// spelling) and a cell that is not finite.
CsvExcerpt ReadCsvExcerpt(const std::filesystem::path& file, std::vector<std::string> needed,
                          std::vector<std::string> optional = {});

/// Reads columns of a CSV file of any length as a stream. Calls `take` for each row with the
/// numbers of `columns`, in that order, and the line on which the row begins. `columns` must not
/// repeat a name. Empty cells are NaN. InputError as ReadCsvExcerpt, after the last row, but
/// without the limit on cells and without rejecting values that are not finite, which are passed
/// on. RunError as ReadFile.
void ReadCsvNumbers(const std::filesystem::path& file, const std::vector<std::string>& columns,
                    char delimiter,
                    const std::function<void(const std::vector<double>& numbers, int line)>& take);

}  // namespace trackbed
