#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/planning/path_file/path_check.h"

namespace trackbed {

/// What a check of a path is of, for its reader.
struct PathCheckTitle {
  std::string name;     ///< of the file
  std::string vehicle;  ///< of the model
  std::string notes;    ///< what was found in the file, a line for each remark
};

/// A check as JSON, without what depends on the station: verdict, largest speed, limits, fit and
/// faults. Speeds that nothing limits are null.
nlohmann::ordered_json PathCheckJson(const PathCheckTitle& title, const FittedPath& fitted,
                                     const PathCheck& check, const PathCheckOptions& options);

/// The same with what the path asks over its stations, for ReportPage: a page with a map, the
/// faults and charts of curvature, steering, lateral acceleration and possible speed.
nlohmann::ordered_json PathCheckReport(const PathCheckTitle& title, const FittedPath& fitted,
                                       const PathCheck& check, const PathCheckOptions& options);

}  // namespace trackbed
