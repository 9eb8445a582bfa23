#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/bag/message.h"

namespace trackbed {

/// Series of rows in a log.
struct LogSource {
  std::filesystem::path file;
  std::string topic;  ///< Topic of a ROS bag; empty for other files.
};

/// Columns that are read from a log, and the delimiter between columns.
struct WantedColumns {
  std::vector<std::string> names;
  std::string time;  ///< Column whose cells may be timestamps (TimestampOrTimeOfDay) in a CSV file.
  char delimiter = ',';
};

using TakeLogRow = std::function<void(const std::vector<double>& numbers, int line)>;

/// Reads the wanted columns of a log by name. The log is a CSV file (ReadCsvColumns), or a GPX, KML
/// or GeoJSON file, whose columns are kGlobeColumns. The log may also be a topic of a ROS bag,
/// whose columns are those of its messages (BagMessage) and kBagTimes. In a bag, `stamp.sec` is the
/// time in the message's header or, without a header, the time at which the message was logged.
/// Throws InputError in the same cases as ReadCsvColumns, ReadGlobeFile, ReadBagMessages and
/// BagMessage.
void ReadLogNumbers(const LogSource& source, const WantedColumns& columns, const TakeLogRow& take);

/// The columns of a GPX, KML or GeoJSON file: seconds since 1970, degrees, degrees and meters.
inline constexpr const char* kGlobeColumns[] = {"time", "latitude", "longitude", "elevation"};

/// Columns that every topic of a bag has: the time at which a message was logged [s, ns].
inline constexpr const char* kBagTimes[] = {"log_time.sec", "log_time.nanosec"};

/// Returns the message type of a topic in a ROS bag. Throws InputError if the bag has no such
/// topic.
BagMessage MessageOfTopic(const std::filesystem::path& file, const std::string& topic);

/// Returns the field of a column of a bag, such as "pose.position.x" of "/odom.pose.position.x".
/// Returns names that are not columns of a bag unchanged.
std::string FieldOfColumn(const std::string& column);
/// Returns the topic of a column of a bag, such as "/odom" of "/odom.pose.position.x"; "" for all
/// other names.
std::string TopicOfColumn(const std::string& column);

}  // namespace trackbed
