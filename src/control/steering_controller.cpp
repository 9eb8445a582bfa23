#include "trackbed/control/steering_controller.h"

namespace trackbed {

std::optional<double> SteeringController::Accelerate(const ControlInput&) {
  return std::nullopt;
}

std::vector<std::string> SteeringController::Columns() const {
  return {};
}

std::vector<double> SteeringController::Values() const {
  return {};
}

std::unique_ptr<SteeringController> SteeringController::Clone() const {
  return nullptr;
}

}  // namespace trackbed
