#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/analysis/json_file.h"

namespace trackbed {

/// Returns a table row for each check of a verdict in metrics.json: {of, metric, what, unit,
/// relation, bound, asked, found, t, met}. Runs of older versions give no rows, because their
/// verdicts list only failures.
nlohmann::ordered_json CheckRows(const JsonValue& verdict);

/// Returns a verdict without its checks, as {passed, failures, notes}.
nlohmann::ordered_json VerdictJson(const JsonValue& verdict);

}  // namespace trackbed
