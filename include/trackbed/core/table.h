#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// A table of numbers with named columns, for the CSV files of a run. The first line of the CSV
/// file contains the column names, which include units ("speed_mps"). Each line after the column
/// names contains the numbers of one row.
///
/// Guarantees: ToCsv writes each number in the shortest form from which the same double can be
/// read, and writes a negative zero as 0. From the text that ToCsv writes, ReadCsv reads the same
/// table. The cells of the table cannot contain text.
class Table {
 public:
  explicit Table(std::vector<std::string> columns);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return cells_.size() / columns_.size(); }

  /// Appends a row. Throws InternalError unless the row has one number per column.
  void AddRow(const std::vector<double>& row);

  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_.size() + column];
  }

  /// Returns the index of the column with the given name, or -1 if the table has no such column.
  [[nodiscard]] int Find(std::string_view column) const;
  /// Returns all numbers of the column with the given name. Throws InputError if the table has no
  /// such column.
  [[nodiscard]] std::vector<double> Column(std::string_view column) const;

  [[nodiscard]] std::string ToCsv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> cells_;  // Numbers of all cells, row by row.
};

/// Reads a table of numbers from a CSV file with a header line (RFC 4180, with libcsv). Skips empty
/// lines, spaces around cells and a byte order mark.
///
/// Throws InputError, naming file and line, if a cell is not a number, if a row has the wrong
/// length, or if a column name is repeated or empty. For a repeated or empty column name, the
/// message also states the number of the cell. Also throws InputError if the file is empty, or has
/// more than 4096 columns, 5e7 cells, or 64 KiB in a cell. The InputError lists the first twenty
/// problems. Throws RunError in the same cases as ReadFile.
Table ReadCsv(const std::filesystem::path& file);

/// Collects the problems of a file. Keeps the first twenty problems in the order of the lines, and
/// counts the omitted problems.
class ProblemList {
 public:
  void Add(Problem problem);
  [[nodiscard]] bool empty() const { return problems_.empty(); }
  /// If there are collected problems, throws an InputError that lists the problems in the order of
  /// the lines.
  void ThrowIfAny() const;

 private:
  std::vector<Problem> problems_;  // The first problems of the file, in the order of its lines.
  std::size_t omitted_ = 0;
};

/// Selected columns of a CSV file from another program.
struct CsvExcerpt {
  Table table;             ///< Requested columns that the file has, in the order of the file.
  std::vector<int> lines;  ///< Line number in the file of each row of the table, from 1.
};

/// Reads all columns `needed` (at least one), and the columns `optional` if the file has them.
/// Ignores other columns. Throws InputError in the same cases as ReadCsv. Also throws InputError if
/// a column of `needed` is missing (the message suggests the most similar name), or if a cell is
/// not a finite number.
CsvExcerpt ReadCsvExcerpt(const std::filesystem::path& file, std::vector<std::string> needed,
                          std::vector<std::string> optional = {});

}  // namespace trackbed
