#include "src/recording/bag_map.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "src/recording/log_source.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Splits the columns of a bag into topics and fields. If the topic of a column differs from the
/// position's topic, LogColumn::file becomes the column's topic.
class MapDivider {
 public:
  MapDivider(const fs::path& log, LogMap map) : log_(log), map_(std::move(map)) {
    LogPosition& position = map_.position;
    topic_ = TopicOfColumn(position.latitude.value_or(position.x));
    if (topic_.empty()) {
      Refuse(position.latitude ? "position.latitude" : "position.x",
             fmt::format("'{}' names no topic; a column of a bag is its topic, a point and its "
                         "field, such as /odom.pose.pose.position.x",
                         position.latitude.value_or(position.x)));
    }
    if (position.latitude) {
      TakeOwn("position.latitude", *position.latitude);
      TakeOwn("position.longitude", *position.longitude);
    } else {
      TakeOwn("position.x", position.x);
      TakeOwn("position.y", position.y);
    }
    if (map_.yaw) {
      TakeOwn("yaw.column", map_.yaw->column);
    }
    if (map_.orientation) {
      TakeOwn("orientation.x", map_.orientation->x);
      TakeOwn("orientation.y", map_.orientation->y);
      TakeOwn("orientation.z", map_.orientation->z);
      TakeOwn("orientation.w", map_.orientation->w);
    }
    for (LogCondition& condition : map_.valid) {
      TakeOwn("valid", condition.column);
    }
    map_.time.column = FieldOfColumn(map_.time.column);
    if (map_.time.nanoseconds) {
      map_.time.nanoseconds = FieldOfColumn(*map_.time.nanoseconds);
    }
    TakeSignal("speed", map_.speed);
    TakeSignal("yaw_rate", map_.yaw_rate);
    TakeSignal("steering", map_.steering);
    TakeSignal("steering_command", map_.steering_command);
    TakeSignal("throttle", map_.throttle);
    if (map_.accelerometer) {
      const std::string other = TopicOfColumn(map_.accelerometer->y);
      TakeColumn("accelerometer", map_.accelerometer->x, map_.accelerometer->file);
      map_.accelerometer->y = FieldOfColumn(map_.accelerometer->y);
      if (other != map_.accelerometer->file.value_or(topic_)) {
        Refuse("accelerometer.y", "x and y must be columns of one topic");
      }
    }
  }

  [[nodiscard]] BagMap Divided() const { return {map_, topic_}; }

 private:
  [[noreturn]] void Refuse(const std::string& key, std::string message) const {
    throw InputError(Problem{.file = log_.string(), .key = key, .message = std::move(message)});
  }

  void TakeOwn(const char* key, std::string& column) const {
    if (TopicOfColumn(column) != topic_) {
      Refuse(key,
             fmt::format("'{}' is not a column of the topic of the position, {}", column, topic_));
    }
    column = FieldOfColumn(column);
  }

  void TakeColumn(const char* key, std::string& column, std::optional<std::string>& file) const {
    const std::string topic = TopicOfColumn(column);
    if (topic.empty() || file) {
      Refuse(key, fmt::format("'{}' must be a topic, a point and a field, such as "
                              "/odom.twist.twist.linear.x, without a file",
                              column));
    }
    if (topic != topic_) {
      file = topic;
    }
    column = FieldOfColumn(column);
  }

  template <typename Column>
  void TakeSignal(const char* key, std::optional<Column>& column) const {
    if (column) {
      TakeColumn(key, column->column, column->file);
    }
  }

  fs::path log_;
  LogMap map_;
  std::string topic_;  // topic of the position
};

}  // namespace

BagMap DivideByTopics(const fs::path& log, LogMap map) {
  return MapDivider(log, std::move(map)).Divided();
}

}  // namespace trackbed
