#pragma once

#include "trackbed/scenario/disturbances.h"

/// The keys of the section `disturb`.
namespace trackbed {

inline constexpr Range kFactor{.min = 0.1, .max = 10.0};
inline constexpr Range kOnCar{.min = -100.0, .max = 100.0};  // [m]

inline void Visit(KeyVisitor& a, SpeedLoss& loss) {
  a.Field({"from", "s", "from this moment on; else from the start"}, loss.from, kNonNegative);
  a.Field({"station", "m", "instead: from this station (`s_m`) on"}, loss.station, kNonNegative);
  a.Field({"speed", "m/s", "the car's largest from then on"}, loss.speed, Need::kRequired,
          kSpeedRange);
}

inline void Visit(KeyVisitor& a, SteeringFaults& faults) {
  a.Field({"factor", "", "the angle that the road wheels get, over the wanted one"}, faults.factor,
          Need::kOptional, kFactor);
  a.Field({"delay", "s", "of the wanted angle on its way to the actuator"}, faults.delay,
          Need::kOptional, Range{.min = 0.0, .max = 10.0});
  a.Field({"backlash", "rad", "the whole play of the steering, at the road wheels"},
          faults.backlash, Need::kOptional, Range{.min = 0.0, .max = 1.5});
}

inline void Visit(KeyVisitor& a, MeasurementNoise& noise) {
  a.Field({"position", "m", "standard deviation of x and of y"}, noise.position, Need::kOptional,
          Range{.min = 0.0, .max = 100.0});
  a.Field({"heading", "rad", "standard deviation of the yaw"}, noise.heading, Need::kOptional,
          Range{.min = 0.0, .max = 3.0});
}

inline void Visit(KeyVisitor& a, Payload& payload) {
  a.Field({"mass", "kg", "of the payload"}, payload.mass, Range{.max = 1e5, .above = 0.0});
  a.Field({"share", "", "instead: its mass over the car's own"}, payload.share,
          Range{.max = 10.0, .above = 0.0});
  a.Field({"x", "m", "where it lies, ahead of the rear axle"}, payload.x, Need::kOptional, kOnCar);
  a.Field({"y", "m", "likewise, to the left"}, payload.y, Need::kOptional, kOnCar);
  a.Field({"z", "m", "likewise, above the ground; else as high as the car's center of gravity"},
          payload.z, Range{.min = 0.0, .max = 100.0});
}

inline void Visit(KeyVisitor& a, Kick& kick) {
  a.Field({"at", "s", "when it comes"}, kick.at, Need::kRequired, kNonNegative);
  a.Field({"displacement", "m", "the car is set aside by this at once, positive to its left"},
          kick.displacement, Range{.min = -10.0, .max = 10.0});
  a.Field({"impulse", "N s",
           "instead: of a force at its center of gravity, positive to its left; "
           "the kinematic car feels none"},
          kick.impulse, Range{.min = -1e6, .max = 1e6});
  a.Field({"duration", "s", "of that force; else 0.1"}, kick.duration,
          Range{.max = 100.0, .above = 0.0});
}

inline void Visit(KeyVisitor& a, Disturbances& disturb) {
  a.Section({"speed_loss", "", "the car becomes slower than it is asked to be"},
            disturb.speed_loss);
  a.Field({"wheelbase", "", "what controllers take it for, over what it is"}, disturb.wheelbase,
          Need::kOptional, kFactor);
  a.Section({"steering", "", "what becomes of the wanted angle before the actuator gets it"},
            disturb.steering);
  a.Section({"noise", "", "of the pose that controllers see, normal and new in every period"},
            disturb.noise);
  a.Section({"payload", "", "a mass that planners and controllers do not know of"},
            disturb.payload);
  a.List({"kicks", "", "what throws the car off sideways"}, disturb.kicks);
  a.Field({"recovered_within", "m", "of the path, for the metric `recovery_time`"},
          disturb.recovered_within, Need::kOptional, kPositive);
}

}  // namespace trackbed
