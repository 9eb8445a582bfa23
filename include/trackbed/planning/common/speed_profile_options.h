#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "trackbed/options/key_visitor.h"

/// The methods for choosing the speeds of a plan (scenario key mission.speed_profile).
namespace trackbed {

/// With constant accelerations, the car accelerates to the mission's speed with the acceleration in
/// control.speed, and brakes with the deceleration in control.speed. Where the car could not follow
/// the plan at the profile's speeds, MakeFeasible lowers the planned speed (feasibility.h).
struct ConstantAccelerationOptions {};
void Visit(KeyVisitor& keys, ConstantAccelerationOptions& options);

/// With a limit profile, the speeds are as high as the car's g-g-v diagram allows
/// (limit_profile.h), but at most the mission's speed.
struct LimitProfileOptions {
  double share = 0.9;  ///< Usable fraction of the forces of tyres, motor and brakes, in (0, 1].
  /// Largest jerk |da/dt| of the car [m/s^3], > 0; none: not limited.
  std::optional<double> jerk{};
};
void Visit(KeyVisitor& keys, LimitProfileOptions& options);

/// The selected method for choosing the speeds of a plan, with the options of the method.
using SpeedProfileOptions = std::variant<ConstantAccelerationOptions, LimitProfileOptions>;

struct SpeedProfileEntry {
  const char* name;
  const char* summary;
  SpeedProfileOptions defaults;
};

/// Returns all methods for choosing the speeds of a plan.
const std::vector<SpeedProfileEntry>& SpeedProfiles();

}  // namespace trackbed
