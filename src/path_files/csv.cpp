#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "src/path_files/csv_columns.h"
#include "src/path_files/csv_globe.h"
#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/table.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/timestamp.h"
#include "trackbed/path_files/globe_names.h"

// Reads paths from CSV tables with a header line of column names (ReadCsvTable). The reader
// identifies columns by their usual names (PathColumnNames) or by names that the caller specifies.
// The reader converts the values to SI units and collects problems with their line and column.
// Directions of motion come from a column of directions or gears, and from the signs of the speeds.
// If the table has times but no speed column, the speeds are computed from the times. Invalid cells
// in the columns of curvature, speed, time and direction only make these columns unusable.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Returns the factor that converts values in `unit` to SI units.
double InSi(const std::string& unit) {
  static const std::vector<std::pair<std::string, double>> units{
      {"m", 1.0},       {"cm", 0.01},         {"mm", 0.001}, {"km", 1000.0},
      {"rad", 1.0},     {"deg", kPi / 180.0}, {"m/s", 1.0},  {"km/h", 1.0 / 3.6},
      {"mph", 0.44704}, {"1/m", 1.0},         {"s", 1.0}};
  const auto found = std::find_if(units.begin(), units.end(),
                                  [&](const auto& entry) { return entry.first == unit; });
  TRACKBED_CHECK(found != units.end(), "no unit '{}'", unit);
  return found->second;
}

/// Column of the table from which a quantity is read.
struct Column {
  std::size_t index;
  double factor;  // factor that converts the column's values to SI units
  double offset = 0.0;
  double largest = 0.0;  // largest permitted magnitude of the quantity, in SI units
};

/// Quantities of a path. The quantities from kCurvature on may be unusable.
enum Quantity { kX, kY, kYaw, kCurvature, kSpeed, kTime, kMotion, kQuantities };

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
          if (is_unnamed_ && !is_broken_) {
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
    if (is_globe_) {
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
    for (const Quantity quantity : {kSpeed, kTime}) {
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
    } else if (columns_[kTime]) {
      TakeTimes(found_, std::move(times_), file_.string());
    }
    FinishHeadings(has_speeds);
  }

  /// Converts the headings to angles from the x axis. If the file has speeds, refuses headings that
  /// are opposite to the direction of travel all along the path.
  void FinishHeadings(bool has_speeds) {
    if (!columns_[kYaw]) {
      return;
    }
    const std::string& name = names_[columns_[kYaw]->index];
    PathPoints& points = found_.points;
    // Do not look for degrees if the unit is given, or is part of the name.
    const bool is_unit_known =
        columns_[kYaw]->factor != 1.0 || requested_.yaw_unit || boost::iends_with(name, "_rad");
    const HeadingReading reading =
        ReadHeadings(points, boost::iequals(name, "psi_rad"), is_unit_known);
    if (!reading.problem.empty() && is_globe_ && !requested_.yaw) {
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

  /// Drops a column of directions that has an invalid cell or says nothing.
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
    // In a column of directions that has only the numbers 0 and 1, they mean false and true.
    if (direction_column_ == DirectionColumn::kSigned && has(0) && has(1) && !has_words_) {
      std::replace(direction.begin(), direction.end(), 0, -1);
    } else if (has(1)) {
      std::fill(direction.begin(), direction.end(), 1);
    } else {
      direction.clear();
    }
  }

  /// Reports an invalid cell. An invalid cell in a column that may be unused is only counted.
  void TakeInvalidCell(Quantity quantity, int line, std::string message) {
    const std::string& name = names_[columns_[quantity]->index];
    if (quantity < kCurvature) {
      AddError(line, name, std::move(message));
    } else if (InvalidCells& invalid = invalid_[quantity]; invalid.count++ == 0) {
      invalid.first = {file_.string(), line, 0, name, std::move(message)};
    }
  }

  void SetHeader(std::vector<std::string> names, int line) {
    names_ = std::move(names);
    std::set<std::string> seen;
    for (const std::string& name : names_) {
      if (!name.empty() && !seen.insert(name).second) {
        AddError(line, name, "repeated column");
        is_broken_ = true;
      }
    }
    const std::array<std::pair<const char*, const std::optional<std::string>*>, kQuantities>
        quantities{{{"x", &requested_.x},
                    {"y", &requested_.y},
                    {"yaw", &requested_.yaw},
                    {"curvature", &requested_.curvature},
                    {"speed", &requested_.speed},
                    {"time", &requested_.time},
                    {"direction", &requested_.direction}}};
    FindGlobe(line);
    if (!is_globe_ && !requested_.x && !requested_.y) {
      FindPose(line);
    }
    for (std::size_t i = is_globe_ ? kYaw : kX; i < kQuantities; ++i) {
      Find(static_cast<Quantity>(i), quantities[i].first, *quantities[i].second, line);
    }
    is_broken_ = is_broken_ || (!is_unnamed_ && (!columns_[kX] || !columns_[kY]));
    if (is_broken_ || is_unnamed_) {
      return;
    }
    // A table of a run with a local origin states the origin in two columns (log_columns.h).
    for (const auto& [name, quantity] :
         {std::pair("origin_x_m", kX), std::pair("origin_y_m", kY)}) {
      const auto own = std::find(names_.begin(), names_.end(), name);
      if (own != names_.end()) {
        origin_columns_[quantity] = static_cast<std::size_t>(own - names_.begin());
      }
    }
    std::vector<std::string> used;
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (columns_[i]) {
        used.push_back(names_[columns_[i]->index]);
      }
    }
    found_.notes.push_back(fmt::format("CSV, columns {}", fmt::join(used, ", ")));
  }

  /// Finds columns of latitude and longitude, unless the file has columns of x and y.
  void FindGlobe(int line) {
    const bool has_plane = requested_.x || requested_.y ||
                           (FindUsualColumn(names_, "x") && FindUsualColumn(names_, "y"));
    const CsvGlobe found = FindCsvGlobe(names_, requested_, has_plane);
    for (const auto& [column, message] : found.problems) {
      AddError(line, column, message);
      is_broken_ = true;
    }
    if (found.latitude && found.longitude) {
      // The limits are those of GlobeProblem, which explains positions that do not exist.
      constexpr double kAny = 1e12;
      columns_[kX] = Column{*found.longitude, found.longitude_unit, 0.0, kAny};
      columns_[kY] = Column{*found.latitude, found.latitude_unit, 0.0, kAny};
      is_globe_ = true;
    }
  }

  /// Finds columns of x, y and yaw whose names are not usual (FindPoseColumns). The two columns of
  /// a file without names are x and y.
  void FindPose(int line) {
    if (AreNumbered(names_)) {
      is_unnamed_ = names_.size() != 2;
      pose_ = {.x = UsualColumn{0, "m"}, .y = UsualColumn{1, "m"}, .yaw = {}, .choices = {}};
      return;
    }
    if (FindUsualColumn(names_, "x") || FindUsualColumn(names_, "y")) {
      return;
    }
    pose_ = FindPoseColumns(names_);
    if (!pose_.choices.empty()) {
      AddError(line, "x",
               fmt::format("several columns for x: {}; name one of them by columns.x, and its y by "
                           "columns.y",
                           fmt::join(pose_.choices, ", ")));
      is_broken_ = true;
    }
  }

  /// Returns the column that the quantity is read from unless the caller names one.
  [[nodiscard]] std::optional<UsualColumn> Usual(Quantity quantity, const char* name) const {
    const std::optional<UsualColumn>& pose = quantity == kX     ? pose_.x
                                             : quantity == kY   ? pose_.y
                                             : quantity == kYaw ? pose_.yaw
                                                                : std::nullopt;
    return pose ? pose : FindUsualColumn(names_, name);
  }

  void Find(Quantity quantity, const char* name, const std::optional<std::string>& requested,
            int line) {
    std::string unit;
    std::optional<std::size_t> index;
    std::vector<std::string> usual;
    for (const PathColumnName& own : PathColumnNames(name)) {
      usual.emplace_back(own.name);
      if (requested && unit.empty() && boost::iequals(*requested, own.name)) {
        unit = own.unit;
      }
    }
    if (requested) {
      const auto own = std::find(names_.begin(), names_.end(), *requested);
      index = own == names_.end() ? std::nullopt : std::optional<std::size_t>(own - names_.begin());
    } else if (const std::optional<UsualColumn> own = Usual(quantity, name)) {
      index = own->index;
      unit = own->unit;
    }
    if (!index) {
      if (requested) {
        AddError(line, *requested,
                 fmt::format("no such column {}", UnknownName(*requested, names_)));
        is_broken_ = true;
      } else if ((quantity == kX || quantity == kY) && !is_unnamed_ && !is_broken_) {
        AddError(line, name,
                 fmt::format("no column for {}: none is called {}; the file has {}; {}", name,
                             fmt::join(usual, ", "), fmt::join(names_, ", "),
                             std::any_of(names_.begin(), names_.end(), NamesGlobeAxis)
                                 ? "name both columns in degrees by columns.latitude and "
                                   "columns.longitude"
                                 : fmt::format("name it by columns.{}", name)));
      }
      return;
    }
    if (quantity == kMotion) {
      direction_column_ = unit == "gear"      ? DirectionColumn::kGear
                          : unit == "forward" ? DirectionColumn::kForward
                          : unit == "reverse" ? DirectionColumn::kReverse
                                              : DirectionColumn::kSigned;
      columns_[kMotion] = Column{.index = *index, .factor = 1.0};
      return;
    }
    const std::string si = PathColumnNames(name).front().unit;
    const std::optional<std::string>* given = quantity <= kY       ? &requested_.position_unit
                                              : quantity == kYaw   ? &requested_.yaw_unit
                                              : quantity == kSpeed ? &requested_.speed_unit
                                                                   : nullptr;
    if (given != nullptr && *given) {
      unit = **given;
    }
    const double largest = quantity <= kY           ? kMaxPosition
                           : quantity == kYaw       ? 1e6
                           : quantity == kSpeed     ? kMaxPathSpeed
                           : quantity == kCurvature ? kMaxPathCurvature
                                                    : 1e12;
    columns_[quantity] = Column{*index, InSi(unit.empty() ? si : unit), 0.0, largest};
  }

  void TakeRow(const std::vector<std::string>& cells, int line) {
    if (cells.size() != names_.size()) {
      AddError(line, "", fmt::format("{} cells, the header has {}", cells.size(), names_.size()));
      return;
    }
    if (found_.points.points.size() >= kMaxPathPoints) {
      is_broken_ = true;
      AddError(line, "", fmt::format("more than {} points", kMaxPathPoints));
      return;
    }
    std::array<double, kQuantities> values{};
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (!columns_[i] || i == kMotion) {
        continue;
      }
      const Column& column = *columns_[i];
      std::optional<double> number = CellNumber(cells[column.index]);
      if (!number && i == kTime) {
        number = TimestampSeconds(cells[column.index]);
      }
      values[i] = number.value_or(0.0) * column.factor + column.offset;
      if (i <= kY && origin_columns_[i]) {
        values[i] += CellNumber(cells[*origin_columns_[i]]).value_or(0.0);
      }
      const auto quantity = static_cast<Quantity>(i);
      if (!number) {
        TakeInvalidCell(quantity, line, NumberProblem(cells[column.index]));
      } else if (values[i] < -column.largest || values[i] > column.largest) {
        TakeInvalidCell(quantity, line,
                        fmt::format("{} is out of range; must be between {} and {} in SI units",
                                    *number, -column.largest, column.largest));
      }
    }
    if (is_globe_) {
      for (const auto& [column, message] :
           CsvGlobeProblems({.latitude = values[kY], .longitude = values[kX]}, names_, cells)) {
        AddError(line, column, message);
      }
    }
    PathPoints& points = found_.points;
    points.points.emplace_back(values[kX], values[kY]);
    points.lines.push_back(line);
    const auto add = [&](Quantity quantity, std::vector<double>& list) {
      if (columns_[quantity]) {
        list.push_back(values[quantity]);
      }
    };
    add(kYaw, points.yaw);
    add(kCurvature, points.curvature);
    add(kSpeed, points.speed);
    add(kTime, times_);
    TakeDirection(cells, line);
  }

  void TakeDirection(const std::vector<std::string>& cells, int line) {
    if (!columns_[kMotion]) {
      return;
    }
    const std::string& cell = cells[columns_[kMotion]->index];
    const std::optional<int> direction = DirectionIn(cell, direction_column_);
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
  PoseColumns pose_;
  bool is_unnamed_ = false;  // whether the columns have numbers that nobody has given
  bool is_globe_ = false;    // whether kX and kY are longitudes and latitudes [deg]
  ProblemList problems_;
  bool is_broken_ = false;
  std::vector<std::string> names_;
  std::array<std::optional<Column>, kQuantities> columns_;
  std::array<std::optional<std::size_t>, 2>
      origin_columns_;  // columns of the local origin, x and y
  std::array<InvalidCells, kQuantities> invalid_;
  std::vector<double> times_;
  DirectionColumn direction_column_ = DirectionColumn::kSigned;
  bool has_words_ = false;  // whether a cell of the direction column is no number
  PathFile found_;
};

}  // namespace

PathFile ReadPathCsv(const fs::path& file, const PathMap& map) {
  return CsvPath(file, map).Read();
}

}  // namespace trackbed
