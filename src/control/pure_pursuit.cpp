#include "trackbed/control/pure_pursuit.h"

#include <algorithm>
#include <cmath>

#include "trackbed/control/steering_controller.h"

namespace trackbed {
namespace {

class PurePursuit final : public SteeringController {
 public:
  explicit PurePursuit(const PurePursuitOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const Path& path = input.reference.path;
    const double distance =
        std::max(options_.distance, options_.time * std::abs(input.state.speed));
    const double u = PreviewAngle(path, input.state.pose, input.station, distance);
    const double steering = std::atan(2.0 * input.vehicle.wheelbase * std::sin(u) / distance);
    const double limit = input.vehicle.steering_limit;
    // Backwards, wheels to the right turn the motion to the left.
    return path.At(input.station).direction * std::clamp(steering, -limit, limit);
  }

 private:
  PurePursuitOptions options_;
};

}  // namespace

std::unique_ptr<SteeringController> MakePurePursuit(const PurePursuitOptions& options) {
  return std::make_unique<PurePursuit>(options);
}

}  // namespace trackbed
