#include "src/sim/car_parts.h"
#include "src/sim/exact_plant.h"
#include "src/sim/plants.h"
#include "trackbed/vehicle/single_track_car.h"

namespace trackbed {

std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup) {
  static_cast<void>(RequireTyres(setup.car, "the plant single_track"));
  const VehicleParams params = Steered(setup);
  const SingleTrackState start = RollingWithoutSlip(params, InPlane(setup.start));
  return std::make_unique<ExactPlant<SingleTrackCar>>(setup.car, SingleTrackCar(params, start));
}

}  // namespace trackbed
