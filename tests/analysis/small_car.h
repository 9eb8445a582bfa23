#pragma once

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A car of which only the size is known.
inline VehicleParams SmallCar() {
  VehicleParams car;
  car.wheelbase = 2.7;
  car.length = 4.0;
  car.width = 1.8;
  car.rear_overhang = 1.0;
  return car;
}

}  // namespace trackbed
