#pragma once

#include <memory>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

std::unique_ptr<SteeringController> MakeOptimalSteering(const OptimalSteeringOptions& options);

}  // namespace trackbed
