#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// How to choose the speeds of a plan: the key mission.speed_profile.
namespace trackbed {

/// Accelerates to the mission's speed with control.speed.acceleration and brakes with its
/// deceleration, and drives slower where the car could not follow (feasibility.h).
struct ConstantAccelerationOptions {};
void Visit(KeyVisitor& keys, ConstantAccelerationOptions& options);

/// As fast as the car's g-g-v diagram allows (limit_profile.h), at most the mission's speed.
struct LimitProfileOptions {
  double share = 0.9;  ///< usable fraction of the forces of tyres, motor and brakes, in (0, 1]
  std::optional<double> jerk{};  ///< largest |da/dt| [m/s^3], > 0; none: no limit
};
void Visit(KeyVisitor& keys, LimitProfileOptions& options);

/// The selected method, with its options.
using SpeedProfileOptions = std::variant<ConstantAccelerationOptions, LimitProfileOptions>;

struct SpeedProfileEntry {
  const char* name;
  const char* summary;
  SpeedProfileOptions defaults;
};

/// All methods.
const std::vector<SpeedProfileEntry>& SpeedProfiles();

}  // namespace trackbed
