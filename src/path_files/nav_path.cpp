#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

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

/// Returns the stamp in the header of a PoseStamped as seconds since the second `*first`, which is
/// set by the first stamp; nullopt if the pose has no stamp.
std::optional<double> StampOf(const json& stamped, std::optional<double>& first) {
  const auto member = [](const json& value, const char* name) -> const json* {
    return value.is_object() && value.contains(name) ? &value.at(name) : nullptr;
  };
  const json* header = member(stamped, "header");
  const json* stamp = header != nullptr ? member(*header, "stamp") : nullptr;
  // ROS 2 writes sec and nanosec, ROS 1 secs and nsecs.
  for (const auto& [seconds, nanoseconds] :
       {std::pair("sec", "nanosec"), std::pair("secs", "nsecs")}) {
    const json* whole = stamp != nullptr ? member(*stamp, seconds) : nullptr;
    const json* rest = stamp != nullptr ? member(*stamp, nanoseconds) : nullptr;
    if (whole != nullptr && whole->is_number() && rest != nullptr && rest->is_number()) {
      first = first.value_or(whole->get<double>());
      return whole->get<double>() - *first + 1e-9 * rest->get<double>();
    }
  }
  return std::nullopt;
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
  std::optional<double> first_second;
  std::vector<double> stamps;
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
    if (const std::optional<double> stamp = StampOf(poses[i], first_second)) {
      stamps.push_back(*stamp);
    }
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
  TakeStamps(found, std::move(stamps), file);
  return found;
}

}  // namespace trackbed
