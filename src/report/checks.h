#pragma once

#include <nlohmann/json.hpp>

namespace trackbed {

/// The checks of a verdict, as metrics.json has them, as the rows of a table: {of, metric, what,
/// unit, relation, bound, asked, found, t, met}. None for a run of an older Trackbed, whose verdict
/// has failures alone.
nlohmann::ordered_json CheckRows(const nlohmann::ordered_json& verdict);

/// What the page says of a verdict beside its checks: {passed, failures, notes}.
nlohmann::ordered_json VerdictJson(const nlohmann::ordered_json& verdict);

}  // namespace trackbed
