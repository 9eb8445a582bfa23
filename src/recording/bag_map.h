#pragma once

#include <filesystem>
#include <string>

#include "trackbed/recording/log_map.h"

namespace trackbed {

/// The map of a bag, with its columns divided into topics and fields.
struct BagMap {
  /// The map, in which the name of a field replaces the name of each column. If the topic of a
  /// column differs from the topic of the position, LogColumn::file is the topic of the column.
  LogMap map;
  std::string topic;  ///< Topic of the position and of the orientation.
};

/// Divides the columns of a map into topics and fields. Throws InputError, with the key, if a
/// column names no topic, or if a column of the pose or of a condition is in another topic.
BagMap DivideByTopics(const std::filesystem::path& log, LogMap map);

}  // namespace trackbed
