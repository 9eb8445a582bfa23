#include "trackbed/planning/common/speed_profile_options.h"

namespace trackbed {

void Visit(KeyVisitor& /*keys*/, ConstantAccelerationOptions& /*options*/) {}

void Visit(KeyVisitor& keys, LimitProfileOptions& options) {
  keys.Field(
      {"share", "",
       "share of the forces of tyres, motor and brakes, and of the steering rate, that is used"},
      options.share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"jerk", "m/s^3", "largest change of the acceleration per second; default: no limit"},
             options.jerk, Range{.max = 1e4, .above = 0.0});
}

const std::vector<SpeedProfileEntry>& SpeedProfiles() {
  static const std::vector<SpeedProfileEntry> entries{
      {"constant_acceleration",
       "the accelerations of control.speed, slower where the car could not follow",
       ConstantAccelerationOptions{}},
      {"limits", "as fast as the car's g-g-v diagram and steering rate allow",
       LimitProfileOptions{}},
  };
  return entries;
}

}  // namespace trackbed
