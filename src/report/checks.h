#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/analysis/json_file.h"

namespace trackbed {

/// Returns a table row for each check of a verdict in metrics.json: {of, metric, what, unit,
/// relation, bound, asked, found, t, met}. For runs of older versions of Trackbed, whose verdicts
/// list only failures, CheckRows returns no rows.
nlohmann::ordered_json CheckRows(const JsonValue& verdict);

/// Returns the JSON of a verdict without its list of checks, as {passed, failures, notes}.
nlohmann::ordered_json VerdictJson(const JsonValue& verdict);

}  // namespace trackbed
