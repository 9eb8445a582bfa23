#pragma once

#include <optional>

#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Measures how long a car has stood still. A car is regarded as standing still while it has moved
/// by at most one centimeter.
class Standstill {
 public:
  /// Returns the time at which the car's present standstill began [s]. If `counts` is false, Update
  /// returns nullopt and restarts the measurement; callers use this to ignore an intended
  /// standstill. Call Update once per control period.
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
