#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/recording/log_map.h"

/// Lists the content of a log, and proposes a map to read it.
namespace trackbed {

/// One series of rows in a log: a CSV file, the tracks of a GPX file, a topic of a bag.
struct LogTopic {
  std::string name;  ///< Topic of a bag; else "".
  std::string type;  ///< Message type of a topic; else the format of the file.
  std::size_t rows = 0;
  std::vector<std::string> columns;  ///< Names as a map uses them.
  std::string problem;               ///< Why the topic cannot be read; empty if it can.
};

struct LogListing {
  std::vector<LogTopic> topics;
  /// A map that reads the log, if its columns have usual names.
  std::optional<LogMap> map;
  std::string problem;  ///< Why the log has no map, such as missing columns; empty if `map` is set.
  std::vector<std::string> notes;  ///< Damaged parts of the log.
};

/// Lists the columns of a log: of a CSV file, a GPX, KML or GeoJSON file, or a bag of ROS 2. Throws
/// InputError in the same cases as ImportLog.
LogListing ListLog(const std::filesystem::path& log);

}  // namespace trackbed
