#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace trackbed {

/// Applies an override such as "mission.speed=4" or "mission.waypoints[1]=[40, 5]" to a YAML tree.
/// ApplyOverride creates missing sections of the YAML tree. ApplyOverride returns the dotted key of
/// the override, such as "mission.speed". Throws InputError if the text is not of the form
/// "key=value", or if a list index is beyond the end of the list.
std::string ApplyOverride(YAML::Node& root, const std::string& text);

}  // namespace trackbed
