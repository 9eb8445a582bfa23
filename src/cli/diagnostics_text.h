#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// Formats the diagnostics of any planner for the terminal. Each list in the diagnostics, such as
/// the turns or corners, is printed as a table; each other field is one line. A non-empty
/// diagnostics text ends with a line feed.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
