#pragma once

#include <filesystem>
#include <optional>

#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

/// The stages in which a scenario's car is compiled: the bare car, the car with its trailer, the
/// car with its payload, and the car in the scenario's world.
namespace trackbed {

/// Loads the car of a model file, without payload and without a world. LoadBareCar throws
/// InputError if the options specify tyre parameters for a vehicle without steered front wheels.
CarModel LoadBareCar(const SceneOptions& options, const std::filesystem::path& file);

/// Returns the car's scene with the scenario's trailer; nullopt if the scenario has no trailer.
std::optional<Scene> TowingScene(const Scenario& scenario, const CarModel& car);

/// Returns the car's scene with the scenario's payload on the car; nullopt if the scenario has no
/// payload.
std::optional<Scene> LadenScene(const Scenario& scenario, const CarModel& car);

/// Returns the car's scene with the ground and obstacles of the scenario's world; nullopt if the
/// world has flat ground and no obstacles.
std::optional<Scene> SceneInWorld(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed
