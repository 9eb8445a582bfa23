#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/analysis/json_file.h"

namespace trackbed {

/// Returns a table row for each check of a verdict in metrics.json: {of, metric, what, unit,
/// relation, bound, asked, found, t, met}. Returns no rows for runs of older versions, whose
/// verdicts list only failures.
nlohmann::ordered_json CheckRows(const JsonValue& verdict);

/// Returns a verdict without the list of checks, as {passed, failures, notes}.
nlohmann::ordered_json VerdictJson(const JsonValue& verdict);

}  // namespace trackbed
