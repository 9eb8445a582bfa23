#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/planning/path_file/path_check.h"

namespace trackbed {

/// Texts in the title of a page on a path check.
struct PathCheckTitle {
  std::string name;     ///< Name of the file.
  std::string vehicle;  ///< Name of the vehicle model.
  std::string notes;    ///< Remarks on the path's file, one per line.
};

/// Returns the result of a path check as JSON: verdict, largest speed, limits, fit and faults, but
/// no values along the path. Unlimited speeds are null.
nlohmann::ordered_json PathCheckJson(const PathCheckTitle& title, const FittedPath& fitted,
                                     const PathCheck& check, const PathCheckOptions& options);

/// Returns the result of a path check as JSON, including the demands on the vehicle at each station
/// of the path. ReportPage makes a page from this JSON, with a map, the faults, and charts of
/// curvature, steering, lateral acceleration and possible speed.
nlohmann::ordered_json PathCheckReport(const PathCheckTitle& title, const FittedPath& fitted,
                                       const PathCheck& check, const PathCheckOptions& options);

}  // namespace trackbed
