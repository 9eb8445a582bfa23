#include "trackbed/control/speed_control_options.h"

#include "src/control/control_keys.h"

namespace trackbed {

void Visit(KeyVisitor& keys, Braking& braking) {
  keys.Field(kBegin, braking.at, Need::kRequired, kNonNegative);
  keys.Field({"deceleration", "m/s^2", "deceleration down to standstill; 0: the car coasts"},
             braking.deceleration, Need::kRequired, kNonNegative);
}

void Visit(KeyVisitor& keys, SpeedControlOptions& options) {
  keys.Field(
      {"acceleration", "m/s^2", "maximum acceleration; also limits the plan's speed profile"},
      options.acceleration, Need::kOptional, kPositive);
  keys.Field({"deceleration", "m/s^2",
              "maximum deceleration of the plan's speed profile; the controller may brake with "
              "twice as much"},
             options.deceleration, Need::kOptional, kPositive);
  keys.Field({"gain", "1/s", "proportional gain: acceleration per speed error"}, options.gain,
             Need::kOptional, kPositive);
  static const PairShape knot{"a knot [t, v]", "knots [t, v]", kNonNegative, kSpeedRange};
  keys.Field({"over_time", "s, m/s",
              "speed profile in place of mission.speed, linear between knots, constant after the "
              "last; limited only by the car"},
             options.over_time.knots, Need::kOptional, knot);
  keys.Section({"braking", "", "braking from a given time on, overrides every other speed command"},
               options.braking);
}

}  // namespace trackbed
