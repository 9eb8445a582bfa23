#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// The shortest text that reads back to the same number; a negative zero is "0".
std::string ShortestText(double number);

/// Two numbers as text with four digits, or with as many as are needed for them to differ.
std::pair<std::string, std::string> FormatDistinct(double first, double second);

/// The finite number that makes up the whole cell; nullopt for any other content.
std::optional<double> CellNumber(const std::string& cell);

/// A line of a CSV file; cells with a comma, a quote or a line end are quoted by RFC 4180.
std::string CsvLine(const std::vector<std::string>& cells);

/// A table of texts with named columns, for results that are not all numbers. An empty cell is a
/// missing value.
///
/// Guarantees: ToCsv writes one header line, then one line per row; cells with a comma, a quote or
/// a line end are quoted by RFC 4180. The output reads back to the same cells.
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

/// Reads a CSV file with a header line as text (RFC 4180 through libcsv), with cells as ToCsv wrote
/// them. InputError with file and line for a row of the wrong length; a repeated or empty column
/// name; an empty file; and more than 4096 columns, 1e7 cells or 64 KiB in a cell. Lists the first
/// twenty problems. RunError as ReadFile. Skips empty lines, spaces around cells and a byte order
/// mark.
TextTable ReadTextCsv(const std::filesystem::path& file);

}  // namespace trackbed
