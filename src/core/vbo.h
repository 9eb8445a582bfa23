#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/core/csv_head.h"

/// Reads tables in VBO files, which data loggers of Racelogic and RaceChrono write.
namespace trackbed {

/// Finds the table in the first lines of a VBO file: the names of its columns in the section
/// [column names], its rows in [data]. Columns get the units that their names in [header] end with,
/// as in "velocity kmh", or the units to which VboCells converts their cells. FindVboHead returns
/// nullopt if the text lacks the section [column names] or [data].
std::optional<CsvHead> FindVboHead(std::string_view begin);

/// Converts the cells of a VBO file to the units and signs of other tables. Times, which the file
/// has as hhmmss.ss, become seconds since the midnight (UTC) before the first row. Latitudes and
/// longitudes, which the file has in minutes, positive to the north and to the west, become
/// degrees, positive to the north and to the east. Rewrites all numbers (NormalizeNumber).
class VboCells {
 public:
  explicit VboCells(const std::vector<std::string>& names);

  /// Converts the cells of a row. Returns a problem if the row has a time that does not exist;
  /// otherwise "". Cells that are not numbers stay unchanged.
  std::string Convert(std::vector<std::string>& cells);

 private:
  enum class Kind { kPlain, kTime, kLatitude, kLongitude };

  std::vector<Kind> kinds_;
  std::optional<double> last_;  // Time of day in the previous row [s].
  double days_ = 0.0;           // 86 400 s for each midnight since the first row.
};

}  // namespace trackbed
