#include "src/path_files/csv_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <set>

#include "src/path_files/csv_columns.h"
#include "src/path_files/csv_globe.h"
#include "src/path_files/reading.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/path_files/globe_names.h"
#include "trackbed/path_files/pose_columns.h"

namespace trackbed {
namespace {

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

class LayoutFinder {
 public:
  LayoutFinder(std::vector<std::string> names, const PathColumns& requested)
      : requested_(requested) {
    layout_.names = std::move(names);
  }

  CsvLayout Find() {
    const auto number = std::find_if(layout_.names.begin(), layout_.names.end(),
                                     [](const std::string& name) { return CellNumber(name); });
    const bool has_number = number != layout_.names.end() && !AreNumbered(layout_.names);
    if (has_number && ConeCell(layout_.names) < layout_.names.size()) {
      AddProblem("", ConesInsteadOfPath());
      return std::move(layout_);
    }
    std::set<std::string> seen;
    for (const std::string& name : layout_.names) {
      if (!name.empty() && !seen.insert(name).second) {
        AddProblem(name, has_number ? "repeated column; this row has numbers instead of the names "
                                      "of columns: add a line of names above, such as x_m,y_m"
                                    : "repeated column");
        if (has_number) {
          return std::move(layout_);
        }
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
    FindGlobe();
    if (!layout_.is_globe && !requested_.x && !requested_.y) {
      FindPose();
    }
    for (std::size_t i = layout_.is_globe ? kYaw : kX; i < kQuantities; ++i) {
      Find(static_cast<PathQuantity>(i), quantities[i].first, *quantities[i].second);
    }
    if (!layout_.problems.empty() || layout_.is_unnamed) {
      return std::move(layout_);
    }
    // A table of a run with a local origin states the origin in two columns (log_columns.h).
    for (const auto& [name, quantity] :
         {std::pair("origin_x_m", kX), std::pair("origin_y_m", kY)}) {
      const auto own = std::find(layout_.names.begin(), layout_.names.end(), name);
      if (own != layout_.names.end()) {
        layout_.origin[quantity] = static_cast<std::size_t>(own - layout_.names.begin());
      }
    }
    return std::move(layout_);
  }

 private:
  /// Adds a problem. After a problem of the header, missing columns are not reported, because the
  /// problem may be their cause.
  void AddProblem(const std::string& column, std::string message) {
    layout_.problems.emplace_back(column, std::move(message));
    is_broken_ = true;
  }

  /// Finds columns of latitude and longitude, unless the file has columns of x and y.
  void FindGlobe() {
    const bool has_plane =
        requested_.x || requested_.y ||
        (FindUsualColumn(layout_.names, "x") && FindUsualColumn(layout_.names, "y"));
    const CsvGlobe found = FindCsvGlobe(layout_.names, requested_, has_plane);
    for (const auto& [column, message] : found.problems) {
      AddProblem(column, message);
    }
    if (found.latitude && found.longitude) {
      // GlobeProblem checks the limits of latitude and longitude, so the columns have no other
      // limit.
      constexpr double kAny = 1e12;
      layout_.columns[kX] = PathColumn{*found.longitude, found.longitude_unit, 0.0, kAny};
      layout_.columns[kY] = PathColumn{*found.latitude, found.latitude_unit, 0.0, kAny};
      layout_.is_globe = true;
    }
  }

  /// Finds columns of x, y and yaw whose names are not usual (FindPoseColumns). The two columns of
  /// a file without names are x and y.
  void FindPose() {
    if (AreNumbered(layout_.names)) {
      layout_.is_unnamed = layout_.names.size() != 2;
      pose_ = {.x = UsualColumn{0, "m"}, .y = UsualColumn{1, "m"}, .yaw = {}, .choices = {}};
      return;
    }
    if (FindUsualColumn(layout_.names, "x") || FindUsualColumn(layout_.names, "y")) {
      return;
    }
    pose_ = FindPoseColumns(layout_.names);
    if (!pose_.choices.empty()) {
      AddProblem(
          "x", fmt::format("several columns for x: {}; name one of them by columns.x, and its y by "
                           "columns.y",
                           fmt::join(pose_.choices, ", ")));
    }
  }

  /// Returns the column that the quantity is read from unless the caller names one.
  [[nodiscard]] std::optional<UsualColumn> Usual(PathQuantity quantity, const char* name) const {
    const std::optional<UsualColumn>& pose = quantity == kX     ? pose_.x
                                             : quantity == kY   ? pose_.y
                                             : quantity == kYaw ? pose_.yaw
                                                                : std::nullopt;
    return pose ? pose : FindUsualColumn(layout_.names, name);
  }

  void Find(PathQuantity quantity, const char* name, const std::optional<std::string>& requested) {
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
      const auto own = std::find(layout_.names.begin(), layout_.names.end(), *requested);
      index = own == layout_.names.end() ? std::nullopt
                                         : std::optional<std::size_t>(own - layout_.names.begin());
    } else if (const std::optional<UsualColumn> own = Usual(quantity, name)) {
      index = own->index;
      unit = own->unit;
    }
    if (!index) {
      if (requested) {
        AddProblem(*requested,
                   fmt::format("no such column {}", UnknownName(*requested, layout_.names)));
      } else if ((quantity == kX || quantity == kY) && !layout_.is_unnamed && !is_broken_) {
        layout_.problems.emplace_back(
            name,
            fmt::format("no column for {}: none is called {}; the file has {}; {}", name,
                        fmt::join(usual, ", "), fmt::join(layout_.names, ", "),
                        std::any_of(layout_.names.begin(), layout_.names.end(), NamesGlobeAxis)
                            ? "name both columns in degrees by columns.latitude and "
                              "columns.longitude"
                            : fmt::format("name it by columns.{}", name)));
      }
      return;
    }
    if (quantity == kMotion) {
      layout_.direction = unit == "gear"      ? DirectionColumn::kGear
                          : unit == "forward" ? DirectionColumn::kForward
                          : unit == "reverse" ? DirectionColumn::kReverse
                                              : DirectionColumn::kSigned;
      layout_.columns[kMotion] = PathColumn{.index = *index, .factor = 1.0};
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
    layout_.columns[quantity] = PathColumn{*index, InSi(unit.empty() ? si : unit), 0.0, largest};
  }

  const PathColumns& requested_;
  PoseColumns pose_;
  bool is_broken_ = false;
  CsvLayout layout_;
};

}  // namespace

std::vector<std::string> CsvLayout::Used() const {
  std::vector<std::string> used;
  for (const std::optional<PathColumn>& column : columns) {
    if (column) {
      used.push_back(names[column->index]);
    }
  }
  return used;
}

CsvLayout FindCsvLayout(std::vector<std::string> names, const PathColumns& requested) {
  return LayoutFinder(std::move(names), requested).Find();
}

}  // namespace trackbed
