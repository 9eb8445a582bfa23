#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "trackbed/planning/path_file/path_check.h"

namespace trackbed {

/// Texts in the title of a path check.
struct PathCheckTitle {
  std::string name;     ///< Name of the file.
  std::string vehicle;  ///< Name of the vehicle model.
  std::string notes;    ///< Remarks on the file, one per line.
};

/// A check as JSON, without values over the station: verdict, largest speed, limits, fit and
/// faults. Speeds without a limit are null.
nlohmann::ordered_json PathCheckJson(const PathCheckTitle& title, const FittedPath& fitted,
                                     const PathCheck& check, const PathCheckOptions& options);

/// Formats a check like PathCheckJson, with the path's demands over its stations. ReportPage makes
/// a page of it with a map, the faults, and charts of curvature, steering, lateral acceleration and
/// possible speed.
nlohmann::ordered_json PathCheckReport(const PathCheckTitle& title, const FittedPath& fitted,
                                       const PathCheck& check, const PathCheckOptions& options);

}  // namespace trackbed
