#pragma once

#include <filesystem>
#include <optional>

#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

/// The stages in which a scenario's car is compiled: the bare car, the car with its trailer,
/// with its payload, and in the scenario's world.
namespace trackbed {

/// Loads the car of a model file, without payload and without a world. Throws InputError if the
/// options give tyre numbers to a vehicle without steered front wheels.
CarModel LoadBareCar(const SceneOptions& options, const std::filesystem::path& file);

/// Returns the car's scene with the scenario's trailer; none if the scenario has no trailer.
std::optional<Scene> TowingScene(const Scenario& scenario, const CarModel& car);

/// Returns the car's scene with the scenario's payload on the car; none if the scenario has no
/// payload.
std::optional<Scene> LadenScene(const Scenario& scenario, const CarModel& car);

/// Returns the car's scene with the ground and obstacles of the scenario's world; none if the
/// ground is flat and has no obstacles.
std::optional<Scene> SceneInWorld(const Scenario& scenario, const CarModel& car);

}  // namespace trackbed
