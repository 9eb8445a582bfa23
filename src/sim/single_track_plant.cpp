#include "src/sim/car_parts.h"
#include "src/sim/exact_plant.h"
#include "src/sim/plants.h"
#include "trackbed/vehicle/single_track_car.h"

namespace trackbed {

std::unique_ptr<Plant> MakeSingleTrackPlant(const PlantSetup& setup) {
  if (setup.car.trailer()) {
    throw InputError(Problem{.key = "vehicle.trailer",
                             .message = "not in the plant single_track, which has no hitch; use "
                                        "the plants kinematic or mujoco, or remove this"});
  }
  static_cast<void>(RequireTyres(setup.car, "the plant single_track"));
  const VehicleParams params = Steered(setup);
  SingleTrackState start = RollingWithoutSlip(params, InPlane(setup.start));
  start.yaw_rate = setup.start.yaw_rate.value_or(start.yaw_rate);
  start.lateral_speed =
      setup.start.lateral_speed.value_or(0.0) + params.cg_to_rear * start.yaw_rate;
  return std::make_unique<ExactPlant<SingleTrackCar>>(setup.car, SingleTrackCar(params, start));
}

}  // namespace trackbed
