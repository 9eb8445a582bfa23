#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Reads bags of ROS 2 (rosbag2): MCAP files, SQLite files, and folders with a metadata.yaml.
namespace trackbed {

/// A topic of a bag.
struct BagTopic {
  std::string name;      ///< Name of the topic, such as "/odom".
  std::string type;      ///< Type of the messages, such as "nav_msgs/msg/Odometry".
  std::string encoding;  ///< Encoding of the messages; "cdr" in ROS 2.
  /// Definition of the type in the format ros2msg; "" if the bag has no definition.
  std::string definition;
  std::size_t messages = 0;
};

/// Receives a message: its bytes, and the time at which the message was logged [ns].
using TakeBagMessage = std::function<void(std::string_view data, std::int64_t log_time)>;

struct BagContent {
  std::vector<BagTopic> topics;    ///< Topics, in the order of their names.
  std::vector<std::string> notes;  ///< Damaged or missing parts of the bag.
};

/// Returns whether a file name ends with .mcap or .db3, or is a folder with a metadata.yaml.
bool IsBag(const std::filesystem::path& bag);

/// Reads the topics of a bag, and counts their messages.
///
/// An MCAP file that its recorder did not finish is read up to its last complete record, with a
/// note. Throws InputError if the file is not a bag, or if it has more than 10000 topics. Also
/// throws InputError if the file is damaged: if a record exceeds its chunk or the file, if a
/// chunk's checksum is wrong, or if SQLite rejects the file. Also throws InputError for
/// compressions other than lz4 and zstd, and for records or decompressed chunks of more than 256
/// MiB. Throws InputError if metadata.yaml names a file outside of the bag's folder. Throws
/// InputError for a file that is compressed as a whole; the message states the command that
/// decompresses the file. Throws RunError if a file cannot be read.
BagContent ReadBagTopics(const std::filesystem::path& bag);

/// Reads all messages of one topic, in the order of the bag (MCAP) or of their times (SQLite).
/// Throws InputError if the bag has no such topic; otherwise throws in the same cases as
/// ReadBagTopics. Reading needs memory for only one chunk of the bag file.
void ReadBagMessages(const std::filesystem::path& bag, const std::string& topic,
                     const TakeBagMessage& take);

}  // namespace trackbed
