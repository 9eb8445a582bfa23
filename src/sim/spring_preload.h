#pragma once

#include <tinyxml2.h>

#include <array>
#include <string>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Changes the preload of the suspension springs in the car's MJCF so that they carry the
/// additional wheel loads `more` [N], in the order of kWheels. If a suspension spring has no name,
/// throws InputError with the key `key`.
void PreloadSprings(const CarModel& car, tinyxml2::XMLElement& root,
                    const std::array<double, 4>& more, const std::string& key);

/// Whether a spring with nonzero stiffness carries the wheel.
bool HasSpring(const CarModel& car, std::size_t wheel);

}  // namespace trackbed
