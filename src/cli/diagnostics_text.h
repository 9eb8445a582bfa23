#pragma once

#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed::cli {

/// Formats the diagnostics of any planner for the terminal. Each list, such as the list of turns or
/// corners, becomes a table; each other field becomes one line. A non-empty summary ends with a
/// line feed.
std::string DiagnosticsText(const Plan& plan);

}  // namespace trackbed::cli
