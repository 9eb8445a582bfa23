#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// How to choose the speeds of a plan: the key mission.speed_profile.
namespace trackbed {

/// Constant accelerations: the car accelerates to the mission's speed with the acceleration in
/// control.speed, and brakes with the deceleration in control.speed. The car drives more slowly
/// where it could not follow the plan otherwise (feasibility.h).
struct ConstantAccelerationOptions {};
void Visit(KeyVisitor& keys, ConstantAccelerationOptions& options);

/// Speeds as high as the car's g-g-v diagram allows (limit_profile.h), at most the mission's speed.
struct LimitProfileOptions {
  double share = 0.9;  ///< Usable fraction of the forces of tyres, motor and brakes, in (0, 1].
  std::optional<double> jerk{};  ///< Largest |da/dt| [m/s^3], > 0; none: not limited.
};
void Visit(KeyVisitor& keys, LimitProfileOptions& options);

/// The selected method, with its options.
using SpeedProfileOptions = std::variant<ConstantAccelerationOptions, LimitProfileOptions>;

struct SpeedProfileEntry {
  const char* name;
  const char* summary;
  SpeedProfileOptions defaults;
};

/// Returns all methods for choosing the speeds of a plan.
const std::vector<SpeedProfileEntry>& SpeedProfiles();

}  // namespace trackbed
