#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// The lines of a CSV table before its rows of numbers. Loggers such as those of AiM, MoTeC and
/// RaceChrono write lines about the session before the names of the columns, and lines of units
/// after the names.
struct CsvHead {
  char delimiter = ',';
  int preamble_lines = 0;            ///< Number of lines before the column names.
  int first_row = 0;                 ///< Line number of the first row of numbers; 0 without units.
  std::vector<std::string> units{};  ///< Unit of each column; "" if the column has no unit.
  bool has_decimal_commas = false;   ///< Whether numbers have decimal commas.
  bool is_vbo = false;               ///< Whether the file is a VBO file.
};

/// Finds the head of a table in the first 64 KiB of the file. The column names are in the topmost
/// of the adjacent lines above the first row of numbers with the same number of cells. Lines above
/// the names are a preamble only if the file's first line has a different number of cells than the
/// names. Lines between the names and the numbers are units if they contain at least one unit and
/// no number. FindCsvHead tries `delimiter` first, then other delimiters, and uses the first one
/// with which the file has a preamble or units. If no delimiter leads to a preamble or units,
/// FindCsvHead uses `delimiter`. In VBO files, FindCsvHead finds the table by the names of sections
/// (FindVboHead).
CsvHead FindCsvHead(const std::filesystem::path& file, char delimiter);

/// Appends the unit to the name of a column, as in "Speed [km/h]", unless the name already has a
/// unit.
std::string NameWithUnit(const std::string& name, const std::string& unit);

}  // namespace trackbed
