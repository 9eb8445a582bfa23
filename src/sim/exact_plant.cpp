#include "src/sim/exact_plant.h"

#include <numbers>

namespace trackbed {

VehicleParams Steered(const PlantSetup& setup) {
  VehicleParams params = setup.car.params();
  if (setup.steering == SteeringInput::kPrescribed) {
    params.steering_rate = 1e9;
    params.steering_limit = 0.5 * std::numbers::pi;
  }
  return params;
}

KinematicState InPlane(const StartState& start) {
  return {.pose = start.pose, .speed = start.speed, .steering = start.steering};
}

}  // namespace trackbed
