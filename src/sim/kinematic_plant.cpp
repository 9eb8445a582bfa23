#include "src/sim/exact_plant.h"
#include "src/sim/plants.h"
#include "trackbed/vehicle/towing_car.h"

namespace trackbed {

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup) {
  const KinematicState start = InPlane(setup.start);
  if (const std::optional<TrailerParts>& trailer = setup.car.trailer()) {
    return std::make_unique<ExactPlant<TowingCar>>(
        setup.car, TowingCar(Steered(setup), ReferencePoint::kRearAxle, start, trailer->params,
                             setup.start.hitch_angle));
  }
  return std::make_unique<ExactPlant<KinematicCar>>(
      setup.car, KinematicCar(Steered(setup), ReferencePoint::kRearAxle, start));
}

}  // namespace trackbed
