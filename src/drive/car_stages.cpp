#include "src/drive/car_stages.h"

#include <fmt/format.h>

#include "trackbed/core/error.h"
#include "trackbed/sim/payload.h"
#include "trackbed/sim/trailer_scene.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed {

CarModel LoadBareCar(const SceneOptions& options, const std::filesystem::path& file) {
  CarModel car(ComposeScene(file, options), file.string());
  if (!options.tyre_numbers.empty() && car.params().kind != VehicleKind::kSteered) {
    throw InputError(
        Problem{.key = "vehicle.tyre_file",
                .message = fmt::format("{} has no steered front wheels, and so no tyre law; remove "
                                       "vehicle.tyre_file",
                                       file.string())});
  }
  return car;
}

std::optional<Scene> TowingScene(const Scenario& scenario, const CarModel& car) {
  const std::optional<TrailerOptions>& trailer = scenario.vehicle.trailer;
  return trailer ? std::optional(WithTrailer(car, MakeTrailer(*trailer, car.params())))
                 : std::nullopt;
}

std::optional<Scene> LadenScene(const Scenario& scenario, const CarModel& car) {
  const std::optional<Payload>& payload = scenario.disturb.payload;
  return payload ? std::optional(WithPayload(car, *payload)) : std::nullopt;
}

std::optional<Scene> SceneInWorld(const Scenario& scenario, const CarModel& car) {
  const World& world = scenario.world;
  const bool empty = !HasObstacles(world) && IsFlat(world.ground);
  return empty ? std::nullopt : std::optional(WithWorld(car.scene(), car.params(), world));
}

}  // namespace trackbed
