#include "trackbed/scenario/car_lengths.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

bool FollowsCarSize(const Key& key, const std::string& method) {
  constexpr std::array<std::string_view, 11> kLengths{
      "safe_distance", "corner_room",   "cell", "margin",      "expand_distance", "corner_cost",
      "switch_cost",   "steering_cost", "gap",  "inner_width", "rrt_step"};
  const bool is_straight_start =
      std::string_view(key.name) == "lead_in" && method.starts_with("rrt");
  return std::string_view(key.unit) == "m" &&
         (is_straight_start ||
          std::find(kLengths.begin(), kLengths.end(), key.name) != kLengths.end());
}

double CarLengthScale(const Scenario& scenario) {
  const VehicleSpec& vehicle = scenario.vehicle;
  if (vehicle.model == VehicleSpec{}.model) {
    return 1.0;  // the default lengths are meant for this default car
  }
  try {
    const std::filesystem::path file = FindModel(vehicle.model, scenario.folder);
    const CarModel car(ComposeScene(file, {.asset_folders = scenario.asset_folders}),
                       file.string());
    return std::min(1.0, car.params().length / kFullSizeCar);
  } catch (const std::runtime_error&) {
    return 1.0;
  }
}

}  // namespace trackbed
