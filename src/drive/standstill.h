#pragma once

#include <optional>

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Measures how long a car has stood, which means moved by no more than a centimeter.
class Standstill {
 public:
  /// The time since which the car stands [s]; none if it moves, or if `counts` is false. Update()
  /// is called once per control period.
  std::optional<double> Update(const VehicleState& state, bool counts) {
    constexpr double kNoMotion = 0.01;  // [m]
    const Vec2 place = state.pose.position();
    if (!counts) {
      since_.reset();
    } else if (!since_ || (place - since_->place).norm() > kNoMotion) {
      since_ = {state.time, place};
    }
    return since_ ? std::optional(since_->time) : std::nullopt;
  }

 private:
  struct Moment {
    double time = 0.0;  // [s]
    Vec2 place;         // [m]
  };
  std::optional<Moment> since_;
};

}  // namespace trackbed
