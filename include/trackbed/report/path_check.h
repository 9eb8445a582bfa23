#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/planning/path_file/path_check.h"

namespace trackbed {

/// Texts in the title of the report page of a path check.
struct PathCheckTitle {
  std::string name;     ///< Name of the path file.
  std::string vehicle;  ///< Name of the vehicle model.
  std::string notes;    ///< Remarks on the path file, one remark per line.
};

/// Returns the result of a path check as JSON: verdict, maximum possible speed, limits, quality of
/// the fit and faults, but no values along the path. An unlimited speed is written as null.
nlohmann::ordered_json PathCheckJson(const PathCheckTitle& title, const FittedPath& fitted,
                                     const PathCheck& check, const PathCheckOptions& options);

/// Returns the result of a path check as JSON, including the steering, acceleration and other
/// demands that the path makes on the vehicle at each station. ReportPage makes a page from this
/// JSON, with a map, the faults, and charts of curvature, steering, lateral acceleration and
/// possible speed.
nlohmann::ordered_json PathCheckReport(const PathCheckTitle& title, const FittedPath& fitted,
                                       const PathCheck& check, const PathCheckOptions& options);

}  // namespace trackbed
