#pragma once

#include <cmath>

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A differential-drive vehicle with the track width b = 0.6 m, the wheel radius r_w = 0.165 m and
/// a turning radius of 0.4 m.
inline VehicleParams WheelPair() {
  VehicleParams pair;
  pair.name = "wheel_pair";
  pair.kind = VehicleKind::kDifferential;
  pair.wheelbase = 0.6;
  pair.track_rear = 0.6;
  pair.cg_to_rear = 0.18;
  pair.wheel_radius = 0.165;
  pair.mass = 80.0;
  pair.yaw_inertia = 9.3;
  pair.steering_limit = std::atan(0.6 / 0.4);
  pair.steering_rate = 1.0;
  pair.length = 1.05;
  pair.width = 0.72;
  pair.height = 0.56;
  pair.rear_overhang = 0.28;
  return pair;
}

}  // namespace trackbed
