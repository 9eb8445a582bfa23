#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"

// Reads the ROS message nav_msgs/Path, whose list `poses` contains messages of type
// geometry_msgs/PoseStamped.
namespace trackbed {
namespace {

using nlohmann::json;

const json& Member(const json& value, const char* name, std::string_view key,
                   const std::string& file) {
  if (!value.is_object() || !value.contains(name)) {
    Refuse(file, std::string(key), fmt::format("has no member {}", name));
  }
  return value.at(name);
}

/// Returns the heading of a quaternion. Returns 0 for an all-zero quaternion, which means that the
/// pose has no orientation.
double Yaw(const json& orientation, const std::string& key, const std::string& file) {
  const auto part = [&](const char* name) {
    return NumberOf(Member(orientation, name, key, file), key + "." + name, 1e6, file);
  };
  const double x = part("x");
  const double y = part("y");
  const double z = part("z");
  const double w = part("w");
  return std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

}  // namespace

PathFile ReadNavPath(const std::filesystem::path& path, const json& message) {
  const std::string file = path.string();
  const bool is_wrapped = message.is_object() && !message.contains("poses") &&
                          message.contains("path") && message["path"].is_object();
  const json& own = is_wrapped ? message["path"] : message;
  const json& poses = Member(own, "poses", is_wrapped ? "path" : "", file);
  if (!poses.is_array()) {
    Refuse(file, "poses", "must be a list of poses");
  }
  PathFile found;
  std::size_t oriented = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string key = fmt::format("poses[{}].pose", i);
    // An element of `poses` is a PoseStamped, which contains a header and a pose. In other
    // messages, such as PoseArray, an element is a pose without a header.
    const json& pose = poses[i].is_object() && poses[i].contains("position")
                           ? poses[i]
                           : Member(poses[i], "pose", fmt::format("poses[{}]", i), file);
    const json& position = Member(pose, "position", key, file);
    const std::string place = key + ".position";
    found.points.points.emplace_back(
        NumberOf(Member(position, "x", place, file), place + ".x", kMaxPosition, file),
        NumberOf(Member(position, "y", place, file), place + ".y", kMaxPosition, file));
    if (pose.contains("orientation")) {
      found.points.yaw.push_back(Yaw(pose["orientation"], key + ".orientation", file));
      ++oriented;
    }
  }
  found.notes.push_back(fmt::format("nav_msgs/Path of {} poses", poses.size()));
  std::vector<double>& yaw = found.points.yaw;
  if (oriented > 0 && oriented < poses.size()) {
    Refuse(file, "poses",
           fmt::format("{} of {} poses have an orientation; must be all or none", oriented,
                       poses.size()));
  }
  // Ignore the headings if all quaternions have their default value, because planners without
  // headings do not set the quaternions.
  if (!yaw.empty() &&
      std::all_of(yaw.begin(), yaw.end(), [](double angle) { return angle == 0.0; })) {
    yaw.clear();
    found.notes.emplace_back("orientations are not set and were ignored");
  }
  const json* header = own.contains("header") ? &own["header"] : nullptr;
  if (header != nullptr && header->is_object() && header->contains("frame_id") &&
      (*header)["frame_id"].is_string()) {
    found.notes.push_back("frame " + (*header)["frame_id"].get<std::string>());
  }
  return found;
}

}  // namespace trackbed
