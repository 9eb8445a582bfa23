#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// Summary of any planner's diagnostics for the terminal. Each list, such as turns or corners, is a
/// table; each other field is one line. The summary ends with a line feed unless it is empty.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
