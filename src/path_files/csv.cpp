#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path_files/csv_columns.h"
#include "src/path_files/csv_globe.h"
#include "src/path_files/csv_layout.h"
#include "src/path_files/formats.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/timestamp.h"
#include "trackbed/path_files/globe_names.h"

// Reads paths from CSV tables with a header line of column names (ReadCsvTable). FindCsvLayout
// identifies the columns by their usual names, or by names that the caller specifies. The reader
// converts the values to SI units and collects problems with their line and column. Directions of
// motion come from a column of directions or gears, and from the signs of the speeds. If the table
// has times but no speed column, the speeds are computed from the times. Invalid cells in the
// columns of curvature, speed, time and direction only make these columns unusable.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Invalid cells of a column.
struct InvalidCells {
  Problem first;
  std::size_t count = 0;
};

class CsvPath {
 public:
  CsvPath(const fs::path& file, const PathMap& map)
      : file_(file), requested_(map.columns), origin_(OriginOf(map)) {}

  PathFile Read() {
    const bool has_names = ReadCsvTable(
        file_, {.delimiter = kFindDelimiter, .numbers_columns = true}, problems_,
        [&](std::vector<std::string>& names, int line) { SetHeader(std::move(names), line); },
        [&](std::vector<std::string>& cells, int line) {
          if (layout_.is_unnamed && !is_broken_) {
            AddError(line, "", UnnamedColumns(cells));
            is_broken_ = true;
          }
          if (!is_broken_) {
            TakeRow(cells, line);
          }
        });
    if (!has_names && problems_.empty()) {
      AddError(1, "", "no rows after the comments");
    }
    problems_.ThrowIfAny();
    FinishOptionalColumns();
    return std::move(found_);
  }

 private:
  void AddError(int line, const std::string& column, std::string message) {
    problems_.Add({file_.string(), line, 0, column, std::move(message)});
  }

  /// Drops the columns of curvature, speed and time that have an invalid cell, and evaluates the
  /// times.
  void FinishOptionalColumns() {
    if (layout_.is_globe) {
      ProjectCsv(found_, times_, origin_, file_);
    }
    PathPoints& points = found_.points;
    const auto describe = [&](const InvalidCells& invalid) {
      return invalid.count > 1 ? fmt::format("{}, and {} more invalid cells in this column",
                                             invalid.first.message, invalid.count - 1)
                               : invalid.first.message;
    };
    if (const InvalidCells& invalid = invalid_[kCurvature]; invalid.count > 0) {
      points.curvature.clear();
      found_.notes.push_back(fmt::format("column {} is ignored: line {}: {}", invalid.first.key,
                                         invalid.first.line, describe(invalid)));
    }
    for (const PathQuantity quantity : {kSpeed, kTime}) {
      if (const InvalidCells& invalid = invalid_[quantity]; invalid.count > 0) {
        found_.speed_problems.push_back(invalid.first);
        found_.speed_problems.back().message = describe(invalid);
      }
    }
    FinishDirections();
    if (!found_.speed_problems.empty()) {
      points.speed.clear();
    }
    const bool has_speeds = !points.speed.empty();
    TakeSignedSpeeds(points);
    if (!found_.speed_problems.empty()) {
      points.speed.clear();
    } else if (layout_.columns[kTime]) {
      TakeTimes(found_, std::move(times_), file_.string());
    }
    FinishHeadings(has_speeds);
  }

  /// Converts the headings to angles from the x axis. If the file has speeds, refuses headings that
  /// are opposite to the direction of travel all along the path.
  void FinishHeadings(bool has_speeds) {
    if (!layout_.columns[kYaw]) {
      return;
    }
    const std::string& name = layout_.names[layout_.columns[kYaw]->index];
    PathPoints& points = found_.points;
    const HeadingUnit unit = layout_.columns[kYaw]->factor != 1.0 || requested_.yaw_unit
                                 ? HeadingUnit::kGiven
                             : boost::iends_with(name, "_rad") ? HeadingUnit::kNamedRadians
                                                               : HeadingUnit::kUnknown;
    const HeadingReading reading = ReadHeadings(points, boost::iequals(name, "psi_rad"), unit);
    if (!reading.problem.empty() && layout_.is_globe && !requested_.yaw) {
      points.yaw.clear();
      found_.notes.push_back(fmt::format("column {} is ignored: {}", name, reading.problem));
      return;
    }
    if (!reading.problem.empty()) {
      Refuse(file_, name, reading.problem);
    }
    for (double& heading : points.yaw) {
      heading += reading.offset;
    }
    if (!reading.note.empty()) {
      found_.notes.push_back(name + " " + reading.note);
    }
    if (has_speeds) {
      if (const std::string problem = HalfTurnProblem(points); !problem.empty()) {
        Refuse(file_, name, problem);
      }
    }
  }

  /// Drops a column of directions that has an invalid cell, or that has neither a forward nor a
  /// reverse direction.
  void FinishDirections() {
    std::vector<int>& direction = found_.points.direction;
    if (const InvalidCells& invalid = invalid_[kMotion]; invalid.count > 0) {
      if (requested_.direction) {
        throw InputError(invalid.first);
      }
      direction.clear();
      found_.notes.push_back(fmt::format("column {} is ignored: line {}: {}", invalid.first.key,
                                         invalid.first.line, invalid.first.message));
    }
    const auto has = [&](int own) {
      return std::find(direction.begin(), direction.end(), own) != direction.end();
    };
    if (has(-1)) {
      return;
    }
    // In a column of directions that has only the numbers 0 and 1, these numbers mean false and
    // true.
    if (layout_.direction == DirectionColumn::kSigned && has(0) && has(1) && !has_words_) {
      std::replace(direction.begin(), direction.end(), 0, -1);
    } else if (has(1)) {
      std::fill(direction.begin(), direction.end(), 1);
    } else {
      direction.clear();
    }
  }

  /// Reports an invalid cell. An invalid cell in a column that may be unused is only counted.
  void TakeInvalidCell(PathQuantity quantity, int line, std::string message) {
    const std::string& name = layout_.names[layout_.columns[quantity]->index];
    if (quantity < kCurvature) {
      AddError(line, name, std::move(message));
    } else if (InvalidCells& invalid = invalid_[quantity]; invalid.count++ == 0) {
      invalid.first = {file_.string(), line, 0, name, std::move(message)};
    }
  }

  void SetHeader(std::vector<std::string> names, int line) {
    layout_ = FindCsvLayout(std::move(names), requested_);
    for (const auto& [column, message] : layout_.problems) {
      AddError(line, column, message);
    }
    is_broken_ = !layout_.problems.empty();
    if (!is_broken_ && !layout_.is_unnamed) {
      found_.notes.push_back(fmt::format("CSV, columns {}", fmt::join(layout_.Used(), ", ")));
    }
  }

  void TakeRow(const std::vector<std::string>& cells, int line) {
    if (cells.size() != layout_.names.size()) {
      AddError(line, "",
               fmt::format("{} cells, the header has {}", cells.size(), layout_.names.size()));
      return;
    }
    if (found_.points.points.size() >= kMaxPathPoints) {
      is_broken_ = true;
      AddError(line, "", fmt::format("more than {} points", kMaxPathPoints));
      return;
    }
    LookForCones(cells, line);
    std::array<double, kQuantities> values{};
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (!layout_.columns[i] || i == kMotion) {
        continue;
      }
      const PathColumn& column = *layout_.columns[i];
      std::optional<double> number = CellNumber(cells[column.index]);
      if (!number && i == kTime) {
        number = TimestampOrTimeOfDay(cells[column.index]);
      }
      values[i] = number.value_or(0.0) * column.factor + column.offset;
      if (i <= kY && layout_.origin[i]) {
        values[i] += CellNumber(cells[*layout_.origin[i]]).value_or(0.0);
      }
      const auto quantity = static_cast<PathQuantity>(i);
      if (!number) {
        TakeInvalidCell(quantity, line, NumberProblem(cells[column.index]));
      } else if (values[i] < -column.largest || values[i] > column.largest) {
        TakeInvalidCell(quantity, line,
                        fmt::format("{} is out of range; must be between {} and {} in SI units",
                                    *number, -column.largest, column.largest));
      }
    }
    if (layout_.is_globe) {
      for (const auto& [column, message] : CsvGlobeProblems(
               {.latitude = values[kY], .longitude = values[kX]}, layout_.names, cells)) {
        AddError(line, column, message);
      }
    }
    PathPoints& points = found_.points;
    points.points.emplace_back(values[kX], values[kY]);
    points.lines.push_back(line);
    const auto add = [&](PathQuantity quantity, std::vector<double>& list) {
      if (layout_.columns[quantity]) {
        list.push_back(values[quantity]);
      }
    };
    add(kYaw, points.yaw);
    add(kCurvature, points.curvature);
    add(kSpeed, points.speed);
    add(kTime, times_);
    TakeDirection(cells, line);
  }

  /// Refuses cones of two colors, unless the caller says which columns are the points of a path.
  void LookForCones(const std::vector<std::string>& cells, int line) {
    if (requested_.x || requested_.y) {
      return;
    }
    cone_column_ = cone_column_.value_or(ConeCell(cells));
    if (*cone_column_ == cells.size()) {
      return;
    }
    const std::string& color = cells[*cone_column_];
    if (first_color_.empty()) {
      first_color_ = color;
    } else if (color != first_color_ && ConeCell({color}) == 0) {
      is_broken_ = true;
      AddError(line, layout_.names[*cone_column_],
               fmt::format("{} after {}: {}", color, first_color_, ConesInsteadOfPath()));
    }
  }

  void TakeDirection(const std::vector<std::string>& cells, int line) {
    if (!layout_.columns[kMotion]) {
      return;
    }
    const std::string& cell = cells[layout_.columns[kMotion]->index];
    const std::optional<int> direction = DirectionIn(cell, layout_.direction);
    if (!direction) {
      TakeInvalidCell(kMotion, line,
                      fmt::format("'{}' is no direction of motion; allowed: 1 or -1, D or R, "
                                  "forward or reverse",
                                  cell));
    }
    has_words_ = has_words_ || !CellNumber(cell);
    found_.points.direction.push_back(direction.value_or(0));
  }

  const fs::path& file_;
  const PathColumns& requested_;
  std::optional<GlobePosition> origin_;
  ProblemList problems_;
  bool is_broken_ = false;
  CsvLayout layout_;
  std::array<InvalidCells, kQuantities> invalid_;
  std::vector<double> times_;
  std::optional<std::size_t>
      cone_column_;  // column of cones' colors; the number of columns if none
  std::string first_color_;
  bool has_words_ = false;  // whether a cell of the direction column is no number
  PathFile found_;
};

}  // namespace

PathFile ReadPathCsv(const fs::path& file, const PathMap& map) {
  return CsvPath(file, map).Read();
}

}  // namespace trackbed
