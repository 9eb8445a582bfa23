#pragma once

#include <string>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Writes a scenario whose files have the names of their copies.
std::string YamlOf(const Scenario& resolved);

}  // namespace trackbed
