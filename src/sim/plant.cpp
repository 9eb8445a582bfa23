#include "trackbed/sim/plant.h"

#include "src/sim/plants.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {

const std::vector<PlantEntry>& Plants() {
  static const std::vector<PlantEntry> table{
      {"kinematic", "single-track kinematics behind the rate-limited steering",
       [](const CarModel& car, const World&, const StartState& start) {
         return MakeKinematicPlant(car, start, ReferencePoint::kRearAxle);
       }},
      {"mujoco", "the MJCF car under MuJoCo's contact dynamics", MakeMujocoPlant},
  };
  return table;
}

std::unique_ptr<Plant> MakePlant(const std::string& name, const CarModel& car, const World& world,
                                 const StartState& start) {
  std::vector<std::string> names;
  for (const PlantEntry& entry : Plants()) {
    if (entry.name == name) {
      return entry.make(car, world, start);
    }
    names.emplace_back(entry.name);
  }
  throw InputError(Problem{.message = "unknown plant " + UnknownName(name, names)});
}

}  // namespace trackbed
