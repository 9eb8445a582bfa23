#pragma once

#include <array>
#include <string>

#include "src/sim/car_parts.h"

namespace trackbed {

/// The driven wheels of a vehicle with differential drive, in the order of its parts.
inline constexpr std::array<const char*, 2> kDrivenWheels{"left", "right"};

/// Whether a model means to be one: it drives single wheels and has no steering.
bool IsWheelPair(const mjModel_& model);

/// As DescribeVehicle, for a vehicle with differential drive.
VehicleDescription DescribeWheelPair(const mjModel_& model, const std::string& file);

}  // namespace trackbed
