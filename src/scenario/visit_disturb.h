#pragma once

#include "trackbed/scenario/disturbances.h"

/// Functions Visit that declare the keys of the section `disturb` of a scenario.
namespace trackbed {

inline constexpr Range kFactor{.min = 0.1, .max = 10.0};
inline constexpr Range kOnCar{.min = -100.0, .max = 100.0};  // [m]

inline void Visit(KeyVisitor& a, SpeedLoss& loss) {
  a.Field({"from", "s", "start time; default: from the start"}, loss.from, kNonNegative);
  a.Field({"station", "m", "start station (`s_m`), instead of `from`"}, loss.station, kNonNegative);
  a.Field({"speed", "m/s", "maximum speed from then on"}, loss.speed, Need::kRequired, kSpeedRange);
}

inline void Visit(KeyVisitor& a, SteeringFaults& faults) {
  a.Field({"factor", "", "ratio of actual to commanded steering angle"}, faults.factor,
          Need::kOptional, kFactor);
  a.Field({"delay", "s", "delay of the steering command"}, faults.delay, Need::kOptional,
          Range{.min = 0.0, .max = 10.0});
  a.Field({"backlash", "rad", "total backlash of the steering, at the road wheels"},
          faults.backlash, Need::kOptional, Range{.min = 0.0, .max = 1.5});
}

inline void Visit(KeyVisitor& a, MeasurementNoise& noise) {
  a.Field({"position", "m", "standard deviation of x and of y"}, noise.position, Need::kOptional,
          Range{.min = 0.0, .max = 100.0});
  a.Field({"heading", "rad", "standard deviation of the yaw"}, noise.heading, Need::kOptional,
          Range{.min = 0.0, .max = 3.0});
}

inline void Visit(KeyVisitor& a, Payload& payload) {
  a.Field({"mass", "kg", "mass of the payload"}, payload.mass, Range{.max = 1e5, .above = 0.0});
  a.Field({"share", "", "mass as a fraction of the car's mass, instead of `mass`"}, payload.share,
          Range{.max = 10.0, .above = 0.0});
  a.Field({"x", "m", "position ahead of the rear axle"}, payload.x, Need::kOptional, kOnCar);
  a.Field({"y", "m", "position to the left"}, payload.y, Need::kOptional, kOnCar);
  a.Field({"z", "m", "height above the ground; default: height of the car's center of gravity"},
          payload.z, Range{.min = 0.0, .max = 100.0});
}

inline void Visit(KeyVisitor& a, Kick& kick) {
  a.Field({"at", "s", "time of the disturbance"}, kick.at, Need::kRequired, kNonNegative);
  a.Field({"displacement", "m", "instantaneous lateral displacement, positive to the left"},
          kick.displacement, Range{.min = -10.0, .max = 10.0});
  a.Field({"impulse", "N s",
           "impulse of a lateral force at the center of gravity, positive to the left, instead of "
           "`displacement`; no effect on the plant kinematic"},
          kick.impulse, Range{.min = -1e6, .max = 1e6});
  a.Field({"duration", "s", "duration of the force; default: 0.1"}, kick.duration,
          Range{.max = 100.0, .above = 0.0});
}

inline void Visit(KeyVisitor& a, Disturbances& disturb) {
  a.Section({"speed_loss", "", "limits the speed below the commanded speed"}, disturb.speed_loss);
  a.Field({"wheelbase", "", "ratio of the wheelbase assumed by controllers to the actual one"},
          disturb.wheelbase, Need::kOptional, kFactor);
  a.Section({"steering", "", "faults between steering command and actuator"}, disturb.steering);
  a.Section(
      {"noise", "",
       "measurement noise of the pose seen by controllers, Gaussian, white over control periods"},
      disturb.noise);
  a.Section({"payload", "", "payload unknown to planners and controllers"}, disturb.payload);
  a.List({"kicks", "", "lateral kicks"}, disturb.kicks);
  a.Field({"recovered_within", "m",
           "distance from the path within which the car has recovered (metric `recovery_time`)"},
          disturb.recovered_within, Need::kOptional, kPositive);
}

}  // namespace trackbed
