#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace trackbed {

/// Applies "mission.speed=4" or "mission.waypoints[1]=[40, 5]" to a YAML tree; sections on the way
/// are made. Returns the dotted key. InputError when it is not of that form, or names an element
/// that a list does not have.
std::string ApplyOverride(YAML::Node& root, const std::string& text);

}  // namespace trackbed
