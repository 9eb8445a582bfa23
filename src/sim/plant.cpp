#include "trackbed/sim/plant.h"

#include <algorithm>

#include "src/sim/plants.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {

const std::vector<PlantEntry>& Plants() {
  static const std::vector<PlantEntry> table{
      {"kinematic", "single-track kinematics behind the rate-limited steering",
       [](const PlantSetup& setup) {
         return MakeKinematicPlant(setup, ReferencePoint::kRearAxle);
       }},
      {"single_track", "linear single-track dynamics with the tyres' cornering stiffness",
       MakeSingleTrackPlant},
      {"mujoco", "the MJCF car in MuJoCo, with the scenario's tyre law", MakeMujocoPlant},
      {"mujoco:contact", "the same, held by the friction of its contacts",
       [](const PlantSetup& setup) {
         PlantSetup own = setup;
         own.tyre = TyreLaw::kContact;
         return MakeMujocoPlant(own);
       }},
      {"mujoco:magic_formula", "the same, held by tyres whose forces grow with slip",
       [](const PlantSetup& setup) {
         PlantSetup own = setup;
         own.tyre = TyreLaw::kMagicFormula;
         return MakeMujocoPlant(own);
       }},
  };
  return table;
}

TyreLaw TyreLawOf(const CarModel& car, TyreLaw tyre) {
  if (tyre != TyreLaw::kAuto) {
    return tyre;
  }
  const bool has_coefficients =
      car.params().kind == VehicleKind::kSteered && car.parts().tyres.has_value();
  return has_coefficients ? TyreLaw::kMagicFormula : TyreLaw::kContact;
}

std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup) {
  std::vector<std::string> names;
  for (const PlantEntry& entry : Plants()) {
    if (entry.name == name) {
      return entry.make(setup);
    }
    names.emplace_back(entry.name);
  }
  throw InputError(Problem{.message = "unknown plant " + UnknownName(name, names)});
}

std::string PlantFileName(const std::string& name) {
  std::string file = name;
  std::replace(file.begin(), file.end(), ':', '-');
  return file;
}

}  // namespace trackbed
