#pragma once

#include <array>
#include <string>

#include "src/sim/car_parts.h"

namespace trackbed {

/// Names of the two driven wheels of a differential drive, in the order of WheelPairParts.
inline constexpr std::array<const char*, 2> kDrivenWheels{"left", "right"};

/// Whether the model is a vehicle with differential drive, which drives each wheel separately and
/// has no steering.
bool IsWheelPair(const mjModel_& model);

/// Finds and checks the parts of a vehicle with differential drive. Throws the same errors as
/// DescribeVehicle.
VehicleDescription DescribeWheelPair(const mjModel_& model, const std::string& file);

}  // namespace trackbed
