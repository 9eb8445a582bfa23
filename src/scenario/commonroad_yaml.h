#pragma once

#include <filesystem>
#include <string>

namespace trackbed {

/// Converts a CommonRoad scenario (path_files/commonroad_scenario.h) to the YAML of a scenario:
///
/// * `vehicle` is the BMW 320i, vehicle 2 of CommonRoad.
/// * `plan` follows the route in the file. If the file has obstacles, `plan` avoids the obstacles
///   by trajectories in the route's Frenet frame.
/// * `world.obstacles` are the obstacles with their motions.
/// * `expect` requires that the car touches no obstacle and meets the goal in time. The requirement
///   `goal` is a formula over the log (requirement/formula.h).
///
/// Throws InputError in the same cases as ReadCommonRoadScenario.
std::string CommonRoadYaml(const std::filesystem::path& file, const std::string& text);

}  // namespace trackbed
