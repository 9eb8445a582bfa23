#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/bag/bag.h"
#include "trackbed/bag/message.h"
#include "trackbed/core/spelling.h"

// Reads a path from a bag of ROS 2. A message nav_msgs/Path has a sequence of poses. In topics of
// other types than nav_msgs/Path, each message has one pose.
namespace trackbed {
namespace {

/// The places of a pose's numbers among the columns of a message.
class BagPoseColumns {
 public:
  explicit BagPoseColumns(const std::vector<std::string>& columns) {
    for (const char* prefix : {"pose.pose.", "pose.", ""}) {
      const auto place = [&](const std::string& name) -> std::optional<std::size_t> {
        const auto found = std::find(columns.begin(), columns.end(), prefix + name);
        return found == columns.end() ? std::nullopt
                                      : std::optional<std::size_t>(found - columns.begin());
      };
      if (place("position.x") && place("position.y")) {
        position_ = {{*place("position.x"), *place("position.y")}};
        if (place("orientation.x") && place("orientation.w")) {
          orientation_ = {{*place("orientation.x"), *place("orientation.y"),
                           *place("orientation.z"), *place("orientation.w")}};
        }
        break;
      }
    }
    const auto seconds = std::find(columns.begin(), columns.end(), "header.stamp.sec");
    const auto nanoseconds = std::find(columns.begin(), columns.end(), "header.stamp.nanosec");
    if (seconds != columns.end() && nanoseconds != columns.end()) {
      stamp_ = {{static_cast<std::size_t>(seconds - columns.begin()),
                 static_cast<std::size_t>(nanoseconds - columns.begin())}};
    }
  }

  [[nodiscard]] bool are_there() const { return position_.has_value(); }

  /// Appends the pose in a row of the bag to the path's points. Returns false if a number is not
  /// finite or too large.
  bool Take(const std::vector<double>& row, PathPoints& points) {
    const Vec2 position(row[(*position_)[0]], row[(*position_)[1]]);
    if (!position.allFinite() || position.cwiseAbs().maxCoeff() > kMaxPosition) {
      return false;
    }
    points.points.push_back(position);
    if (stamp_) {
      const double second = row[(*stamp_)[0]];
      first_second_ = first_second_.value_or(second);
      stamps_.push_back(second - *first_second_ + 1e-9 * row[(*stamp_)[1]]);
    }
    if (orientation_) {
      const auto& at = *orientation_;
      const double x = row[at[0]];
      const double y = row[at[1]];
      const double z = row[at[2]];
      const double w = row[at[3]];
      const double square = x * x + y * y + z * z + w * w;
      // Planners without headings write a quaternion of zeros or the identity.
      has_heading_ = has_heading_ || (x != 0.0 || y != 0.0 || z != 0.0);
      if (std::isfinite(square) && square > 0.0) {
        points.yaw.push_back(std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z));
      }
    }
    return true;
  }

  /// Drops headings that a writer has not set, and evaluates the stamps.
  void Finish(PathFile& found, const std::string& file) {
    PathPoints& points = found.points;
    TakeStamps(found, std::move(stamps_), file);
    if (!has_heading_ || points.yaw.size() != points.points.size()) {
      points.yaw.clear();
    }
  }

 private:
  std::optional<std::array<std::size_t, 2>> position_;
  std::optional<std::array<std::size_t, 4>> orientation_;
  std::optional<std::array<std::size_t, 2>> stamp_;  // Seconds and nanoseconds.
  std::optional<double> first_second_;               // Whole seconds of the first time stamp [s].
  std::vector<double> stamps_;                       // Time stamps relative to first_second_ [s].
  bool has_heading_ = false;
};

/// Returns the topic that the user names, or the only topic of paths.
BagTopic TopicOfPath(const std::filesystem::path& file, const PathMap& map) {
  const BagContent content = ReadBagTopics(file);
  std::vector<std::string> names;
  std::vector<const BagTopic*> paths;
  for (const BagTopic& topic : content.topics) {
    names.push_back(topic.name);
    if (map.topic ? topic.name == *map.topic
                  : topic.type == "nav_msgs/msg/Path" && topic.messages > 0) {
      paths.push_back(&topic);
    }
  }
  if (map.topic && paths.empty()) {
    Refuse(file, "topic", fmt::format("no topic {}", UnknownName(*map.topic, names)));
  }
  if (paths.size() != 1) {
    Refuse(file, "topic",
           fmt::format("{} topics have messages of the type nav_msgs/Path; name one of the topics "
                       "by topic: {}",
                       paths.size(), fmt::join(names, ", ")));
  }
  if (paths.front()->encoding != "cdr") {
    Refuse(
        file, paths.front()->name,
        fmt::format("its messages are in the encoding '{}'; must be cdr", paths.front()->encoding));
  }
  return *paths.front();
}

}  // namespace

PathFile ReadPathBag(const std::filesystem::path& file, const PathMap& map) {
  const BagTopic topic = TopicOfPath(file, map);
  const BagMessage message(topic.type, topic.definition);
  BagPoseColumns own(message.columns());
  BagPoseColumns of_elements(message.element_columns());
  const bool is_path = !own.are_there();
  BagPoseColumns& columns = is_path ? of_elements : own;
  if (!columns.are_there()) {
    Refuse(file, topic.name, fmt::format("messages of the type {} have no position", topic.type));
  }
  PathFile found;
  std::size_t count = 0;
  ReadBagMessages(file, topic.name, [&](std::string_view data, std::int64_t /*time*/) {
    if (is_path && count > 0) {
      return;
    }
    ++count;
    std::vector<double> numbers;
    std::vector<std::vector<double>> elements;
    message.Read(data, numbers, is_path ? &elements : nullptr);
    if (!is_path) {
      elements.push_back(std::move(numbers));
    }
    for (const std::vector<double>& row : elements) {
      if (found.points.points.size() >= kMaxPathPoints) {
        Refuse(file, topic.name, fmt::format("more than {} points", kMaxPathPoints));
      }
      if (!columns.Take(row, found.points)) {
        Refuse(file, topic.name,
               fmt::format("position {} is not finite, or beyond {} m",
                           found.points.points.size() + 1, kMaxPosition));
      }
    }
  });
  columns.Finish(found, file.string());
  found.notes.push_back(
      fmt::format("rosbag2, topic {} ({}), {}", topic.name, topic.type,
                  is_path ? fmt::format("the first of {} messages", topic.messages)
                          : fmt::format("the positions of {} messages", topic.messages)));
  return found;
}

}  // namespace trackbed
