#include "trackbed/sim/plant.h"

#include <cmath>
#include <string_view>
#include <utility>

#include "src/sim/plants.h"
#include "src/sim/steering_filter_plant.h"
#include "trackbed/core/error.h"
#include "trackbed/options/registry.h"

namespace trackbed {

namespace {

template <TyreLaw law>
std::unique_ptr<Plant> MakeMujocoWith(const PlantSetup& setup) {
  PlantSetup own = setup;
  own.tyre = law;
  return MakeMujocoPlant(own);
}

/// Returns the registry of all plants (vehicle models); each line of the initializer defines one
/// plant.
Registry<PlantEntry>& Table() {
  static Registry<PlantEntry> table(
      "plant",
      {
          {"kinematic", "kinematic single-track model with rate-limited steering",
           MakeIdealKinematicPlant},
          {"single_track", "linear dynamic single-track model with the tyres' cornering stiffness",
           MakeSingleTrackPlant},
          {"mujoco", "MJCF model in MuJoCo, with the scenario's tyre model", MakeMujocoPlant},
          {"mujoco:contact", "the same, with MuJoCo contact friction",
           MakeMujocoWith<TyreLaw::kContact>},
          {"mujoco:magic_formula", "the same, with slip-based Magic Formula tyres",
           MakeMujocoWith<TyreLaw::kMagicFormula>},
      });
  return table;
}

}  // namespace

const std::vector<PlantEntry>& Plants() {
  return Table().entries();
}

void RegisterPlant(PlantEntry entry) {
  TRACKBED_REQUIRE(std::string_view(entry.name) != kRecordedPlant,
                   "RegisterPlant: '{}' is what recorded drives are called", entry.name);
  Table().Add(std::move(entry));
}

TyreLaw SelectTyreLaw(const CarModel& car, TyreLaw tyre) {
  if (tyre != TyreLaw::kAuto) {
    return tyre;
  }
  const bool has_coefficients =
      car.params().kind == VehicleKind::kSteered && car.parts().tyres.has_value();
  return has_coefficients ? TyreLaw::kMagicFormula : TyreLaw::kContact;
}

std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup) {
  const StartState& start = setup.start;
  TRACKBED_REQUIRE(start.pose.position().allFinite() && std::isfinite(start.pose.yaw) &&
                       std::isfinite(start.speed) && std::isfinite(start.steering) &&
                       std::isfinite(start.lateral_speed.value_or(0.0)) &&
                       std::isfinite(start.yaw_rate.value_or(0.0)),
                   "MakePlant: the start is at {}, {}, yaw {}, {} m/s, steering {}, lateral speed "
                   "{}, yaw rate {}; must be finite",
                   start.pose.x, start.pose.y, start.pose.yaw, start.speed, start.steering,
                   start.lateral_speed.value_or(0.0), start.yaw_rate.value_or(0.0));
  return WithSteeringResponse(Table().Find(name).make(setup), setup);
}

}  // namespace trackbed
