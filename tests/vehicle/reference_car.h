#pragma once

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// The car of Skackauskas et al. 2017 and of listings F.1 and F.2 of Skackauskas, dissertation.
/// This function contains the car's numbers, so tests of higher modules need no compiled model.
inline VehicleParams ReferenceCar() {
  VehicleParams car;
  car.name = "reference_car";
  car.wheelbase = 2.7;
  car.cg_to_rear = 1.4;
  car.track_front = 1.505;
  car.track_rear = 1.48;
  car.wheel_radius = 0.31;
  car.mass = 1317.0;
  car.steering_limit = 0.48689923181126915;  // atan(2.7/5.1)
  car.steering_rate = 0.15056818181818182;   // 2.65/17.6
  car.steering_ratio = 17.6;
  car.length = 4.45;
  car.width = 1.725;
  car.height = 1.49;
  car.rear_overhang = 0.825;
  return car;
}

}  // namespace trackbed
