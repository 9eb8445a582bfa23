#pragma once

#include <nlohmann/json.hpp>

namespace trackbed {

/// The checks of a verdict, as metrics.json has them, as the rows of a table: {of, what, unit,
/// asked, found, met}. None for a run of an older Trackbed, whose verdict has failures alone.
nlohmann::ordered_json CheckRows(const nlohmann::ordered_json& verdict);

}  // namespace trackbed
