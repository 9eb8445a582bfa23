#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Finds the columns of a CSV file by their names.
namespace trackbed {

/// A column, and the unit that its name implies.
struct UsualColumn {
  std::size_t index = 0;
  std::string unit;
};

/// Returns the column that has one of the usual names of a quantity (PathColumnNames), ignoring
/// case.
std::optional<UsualColumn> FindUsualColumn(const std::vector<std::string>& names,
                                           std::string_view quantity);

/// Columns of a pose. Their names consist of a usual name and words that describe a pose, such as
/// "pose_x", "pose_y" and "pose_theta", "odom.pose.position.x", "posX", "X (m)" or "utm_x_cm".
struct PoseColumns {
  std::optional<UsualColumn> x;
  std::optional<UsualColumn> y;
  std::optional<UsualColumn> yaw;
  /// If the columns of several poses match, the names of their x columns; `x`, `y` and `yaw` are
  /// then empty.
  std::vector<std::string> choices;
};

/// Finds the columns of a pose. Yaw is only set together with x and y.
PoseColumns FindPoseColumns(const std::vector<std::string>& names);

/// Returns whether the names of the columns are numbers (CsvLimits::numbers_columns).
bool AreNumbered(const std::vector<std::string>& names);

/// Explains which numbers to give for the columns of a file without names, by the cells of its
/// first row.
std::string UnnamedColumns(const std::vector<std::string>& row);

}  // namespace trackbed
