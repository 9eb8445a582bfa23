#pragma once

#include <array>
#include <string>

#include "src/sim/car_parts.h"

namespace trackbed {

/// The driven wheels of a differential drive, in the order of WheelPairParts.
inline constexpr std::array<const char*, 2> kDrivenWheels{"left", "right"};

/// Whether a model describes a differential drive, which drives single wheels and has no steering.
bool IsWheelPair(const mjModel_& model);

/// Same as DescribeVehicle, for a differential drive.
VehicleDescription DescribeWheelPair(const mjModel_& model, const std::string& file);

}  // namespace trackbed
