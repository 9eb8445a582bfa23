#include "src/control/turn_round.h"

#include <algorithm>
#include <cmath>

#include "src/control/preview_distance.h"
#include "src/control/steering_limit.h"
#include "trackbed/control/preview.h"
#include "trackbed/core/angle.h"

namespace trackbed {
std::optional<double> TurnRound::Steer(const ControlInput& input, double u) {
  const Path& path = input.reference.path;
  // The angle from the direction of the path to the target point P is u + psi.
  if (std::cos(u) >= 0.0 ||
      std::cos(u + AngleDifference(input.state.pose.yaw, path.At(input.station).pose.yaw)) < 0.0) {
    side_ = 0.0;
    return std::nullopt;
  }
  if (side_ == 0.0) {
    side_ = std::copysign(1.0, u);
  }
  const int direction = path.BendAt(input.station).direction;
  return direction * side_ * TurnRoundLimit(input.vehicle, input.state.speed);
}

std::optional<double> TurnRound::Steer(const ControlInput& input) {
  const double heading_error =
      AngleDifference(input.state.pose.yaw, input.reference.path.At(input.station).pose.yaw);
  // A control law without a preview point needs no turn round if the car's heading error is below
  // 90 degrees.
  if (std::cos(heading_error) > 0.0) {
    side_ = 0.0;
    return std::nullopt;
  }
  return Steer(input, PreviewAngle(input.reference.path, input.state.pose, input.station,
                                   std::max(PreviewDistance(input), ReturnDistance(input))));
}

}  // namespace trackbed
