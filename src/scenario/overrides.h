#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace trackbed {

/// Applies an override such as "mission.speed=4" or "mission.waypoints[1]=[40, 5]" to a YAML tree.
/// Missing sections of the tree are created. ApplyOverride returns the dotted key of the override.
/// Throws InputError for text that is not an override, and for an index beyond the end of a list.
std::string ApplyOverride(YAML::Node& root, const std::string& text);

}  // namespace trackbed
