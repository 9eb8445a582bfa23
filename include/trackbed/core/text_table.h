#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Formats a number as the shortest text from which the same number can be read. Returns "0" for a
/// negative zero.
std::string ShortestText(double number);

/// Formats two numbers with four digits, or with as many digits as are needed to distinguish them.
std::pair<std::string, std::string> FormatDistinct(double first, double second);

/// Returns the number in a cell; nullopt if the cell does not contain a finite number.
std::optional<double> CellNumber(const std::string& cell);

/// Formats cells as a line of a CSV file. Puts cells with a comma, a quote or a line end in quotes,
/// as RFC 4180 requires.
std::string CsvLine(const std::vector<std::string>& cells);

/// A table of texts with named columns, for results that contain other values besides numbers. An
/// empty cell represents a missing value.
///
/// Guarantees: ToCsv writes one header line, then one line per row. ToCsv puts cells with a comma,
/// a quote or a line end in quotes, as RFC 4180 requires. ReadTextCsv reads the same cells from the
/// text that ToCsv writes.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> columns);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }

  /// Appends a row. Throws InternalError unless the row has one cell per column.
  void AddRow(std::vector<std::string> row);

  [[nodiscard]] std::string ToCsv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Reads a table of texts from a CSV file with a header line (RFC 4180, with libcsv). From a file
/// that ToCsv wrote, ReadTextCsv reads the same cells. Skips empty lines, spaces around cells and a
/// byte order mark.
///
/// Throws InputError, naming file and line, if a row has the wrong length, or if a column name is
/// repeated or empty. Also throws InputError if the file is empty, or has more than 4096 columns,
/// 1e7 cells, or 64 KiB in a cell. The InputError lists the first twenty problems. Throws RunError
/// in the same cases as ReadFile.
TextTable ReadTextCsv(const std::filesystem::path& file);

}  // namespace trackbed
