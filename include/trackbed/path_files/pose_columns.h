#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Finds the columns of a pose by their names, in path files and in logs of drives.
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

/// Columns of a pose. The names of pose columns consist of a usual name and words that describe a
/// pose, such as "pose_x", "pose_y" and "pose_theta", "odom.pose.position.x", "posX", "x_pos", "X
/// (m)" or "utm_x_cm". Other names of x and y are "px" and "py", "east" and "north".
struct PoseColumns {
  std::optional<UsualColumn> x;
  std::optional<UsualColumn> y;
  std::optional<UsualColumn> yaw;
  /// Names of the x columns if the columns of several poses match; `x`, `y` and `yaw` are then
  /// empty.
  std::vector<std::string> choices;
};

/// Finds the columns of a pose. The yaw column is only set together with the x and y columns.
PoseColumns FindPoseColumns(const std::vector<std::string>& names);

}  // namespace trackbed
