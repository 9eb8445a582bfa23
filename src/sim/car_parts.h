#pragma once

#include <string>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// What Trackbed knows of a car, read from its compiled model.
struct CarDescription {
  CarParts parts;
  VehicleParams params;
};

/// InputError naming `file` and every part that is missing; or, when all are there, every one that
/// is not as docs/models.md asks.
CarDescription DescribeCar(const mjModel_& model, const std::string& file);

}  // namespace trackbed
