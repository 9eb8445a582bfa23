#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// A summary of a plan's diagnostics for the terminal, whatever planner it is from: a table for
/// each list, such as turns or corners, and a line for every other field. Ends with a line feed,
/// or is empty.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
