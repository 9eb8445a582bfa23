#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/core/csv_head.h"

/// Reads tables in VBO files, which data loggers of Racelogic and RaceChrono write.
namespace trackbed {

/// Finds the table in the first lines of a VBO file. The column names are in the section [column
/// names], the rows in the section [data]. The unit of a column is the last word of its description
/// in [header], as in "velocity kmh", or the unit to which VboCells converts its cells. FindVboHead
/// returns nullopt if the text lacks the section [column names] or [data].
std::optional<CsvHead> FindVboHead(std::string_view begin);

/// Converts the cells of a VBO file to the units and signs of other tables. Times in the format
/// hhmmss.ss become seconds since the midnight (UTC) before the first row. Latitudes and longitudes
/// become degrees, positive to the north and east; in VBO files, they are minutes, positive to the
/// north and west. VboCells also rewrites all numbers (NormalizeNumber).
class VboCells {
 public:
  explicit VboCells(const std::vector<std::string>& names);

  /// Converts the cells of a row of a VBO file. Returns an error message if the row contains an
  /// invalid time of day; otherwise "". Cells that are not numbers stay unchanged.
  std::string Convert(std::vector<std::string>& cells);

 private:
  enum class Kind { kPlain, kTime, kLatitude, kLongitude };

  std::vector<Kind> kinds_;
  std::optional<double> last_;  // Time of day in the previous row [s].
  double days_ = 0.0;           // 86 400 s for each midnight since the first row.
};

}  // namespace trackbed
