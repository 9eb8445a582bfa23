#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace trackbed {

/// Applies an override to a YAML tree, such as "mission.speed=4" or "mission.waypoints[1]=[40, 5]".
/// Missing sections of the tree are created. ApplyOverride returns the dotted key of the override.
/// Throws InputError for text in another format, and for an index beyond the end of a list.
std::string ApplyOverride(YAML::Node& root, const std::string& text);

}  // namespace trackbed
