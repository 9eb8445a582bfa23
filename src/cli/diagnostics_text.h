#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// Summary of a plan's diagnostics for the terminal, for any planner: a table per list, such as
/// turns or corners, and one line per other field. Ends with a line feed unless empty.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
