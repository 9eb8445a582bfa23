#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// The shortest text that reads back to the same number. A negative zero gives "0".
std::string ShortestText(double number);

/// Formats two numbers with four digits, or with as many digits as are needed to distinguish them.
std::pair<std::string, std::string> FormatDistinct(double first, double second);

/// The finite number that a cell contains; nullopt if the cell contains anything else.
std::optional<double> CellNumber(const std::string& cell);

/// Formats cells as a line of a CSV file. Cells with a comma, a quote or a line end are quoted by
/// RFC 4180.
std::string CsvLine(const std::vector<std::string>& cells);

/// A table of texts with named columns, for results that are not all numbers. An empty cell
/// represents a missing value.
///
/// Guarantees: ToCsv writes one header line, then one line per row. Cells with a comma, a quote or
/// a line end are quoted by RFC 4180. ReadTextCsv restores the same cells from the output.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> columns);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }

  /// Appends a row; InternalError unless it has one cell per column.
  void AddRow(std::vector<std::string> row);

  [[nodiscard]] std::string ToCsv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Reads a CSV file with a header line as text (RFC 4180 through libcsv). The cells equal those
/// that ToCsv wrote. Skips empty lines, spaces around cells and a byte order mark.
///
/// InputError with file and line for a row of the wrong length, and for a repeated or empty column
/// name. InputError for an empty file, and for more than 4096 columns, 1e7 cells or 64 KiB in a
/// cell. Lists the first twenty problems. Throws the RunErrors of ReadFile.
TextTable ReadTextCsv(const std::filesystem::path& file);

}  // namespace trackbed
