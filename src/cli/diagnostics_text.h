#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// Formats the diagnostics of any planner for the terminal. Each list, such as turns or corners,
/// becomes a table; each other field becomes one line. The summary ends with a line feed unless it
/// is empty.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
