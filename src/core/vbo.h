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
/// as in "velocity kmh", and those that VboCells gives them. Returns nullopt if the text has no
/// such sections.
std::optional<CsvHead> FindVboHead(std::string_view begin);

/// Converts the cells of a VBO file to the numbers of other tables. Times become seconds since
/// midnight UTC, also those after the next midnight; the file has them as hhmmss.ss. Latitudes and
/// longitudes become degrees, positive to the north and to the east; the file has minutes, positive
/// to the north and to the west. Rewrites all numbers (NormalizeNumber).
class VboCells {
 public:
  explicit VboCells(const std::vector<std::string>& names);

  /// Converts the cells of a row. Returns a problem if the row has a time that does not exist; ""
  /// if it has none. Does not change cells that are not numbers.
  std::string Convert(std::vector<std::string>& cells);

 private:
  enum class Kind { kPlain, kTime, kLatitude, kLongitude };

  std::vector<Kind> kinds_;
  std::optional<double> last_;  // Time of day in the previous row [s].
  double days_ = 0.0;           // Duration of the days since the first row [s].
};

}  // namespace trackbed
