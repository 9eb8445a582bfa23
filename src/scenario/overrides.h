#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace trackbed {

/// Applies "mission.speed=4" or "mission.waypoints[1]=[40, 5]" to a YAML tree and creates missing
/// sections. Returns the dotted key. Throws InputError for another format and for an index beyond
/// the end of a list.
std::string ApplyOverride(YAML::Node& root, const std::string& text);

}  // namespace trackbed
