#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/recording/log_map.h"

/// Lists the content of a log, and proposes a log map (description of its columns) to read it.
namespace trackbed {

/// One series of rows in a log: a CSV file, the tracks of a GPX file, a topic of a bag.
struct LogTopic {
  std::string name;  ///< Name of a topic of a ROS bag; "" for other files.
  std::string type;  ///< Message type of a topic of a bag; format of the file for other files.
  std::size_t rows = 0;
  std::vector<std::string> columns;  ///< Names of the columns, as in a log map.
  std::string problem;               ///< Why the topic cannot be read; empty if it is readable.
};

struct LogListing {
  std::vector<LogTopic> topics;
  /// Proposed log map (description of the columns) to read the log; nullopt unless the log's
  /// columns have usual names.
  std::optional<LogMap> map;
  /// Why no log map can be proposed, such as missing columns; empty if `map` is set.
  std::string problem;
  std::vector<std::string> notes;  ///< Notes on damaged parts of the log.
};

/// Lists the columns of a log: of a CSV file, a GPX, KML or GeoJSON file, or a bag of ROS 2. Throws
/// InputError in the same cases as ImportLog.
LogListing ListLog(const std::filesystem::path& log);

}  // namespace trackbed
