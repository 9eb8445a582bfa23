#pragma once

#include <nlohmann/json.hpp>

#include "trackbed/analysis/json_file.h"

namespace trackbed {

/// Table rows for the checks of a verdict in metrics.json: {of, metric, what, unit, relation,
/// bound, asked, found, t, met}. CheckRows returns nothing for runs of older versions, whose
/// verdicts only have failures.
nlohmann::ordered_json CheckRows(const JsonValue& verdict);

/// A verdict without its checks: {passed, failures, notes}.
nlohmann::ordered_json VerdictJson(const JsonValue& verdict);

}  // namespace trackbed
