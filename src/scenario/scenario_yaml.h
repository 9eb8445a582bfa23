#pragma once

#include <string>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the YAML text of a resolved scenario, whose file names are the names of the copies in a
/// run folder.
std::string YamlOf(const Scenario& resolved);

}  // namespace trackbed
