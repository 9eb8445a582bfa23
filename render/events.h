#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// What happens to a car during a run, beside its driving.
struct RunEvent {
  enum class Kind {
    kObstacleKnown,  ///< the planner learns of an obstacle that was there before
    kNewPlan,        ///< the car takes up a new plan
    kRateLimit,      ///< the steering turns as fast as it can and is behind its command
    kCollision,      ///< first contact with an obstacle
    kRollOver,       ///< the car tips over
  };
  Kind kind = Kind::kNewPlan;
  double from = 0;    ///< [s]
  double to = 0;      ///< when it is over; an event without a duration: `from` [s]
  Point place;        ///< of the car's rear axle when it begins, on the ground
  std::string text;   ///< for people
  int obstacle = -1;  ///< which one, of kObstacleKnown
};

/// The events of the recorded car, `recording.plants.front()`, in the order of time.
///
/// An obstacle becomes known in the first control period in which IsKnown of world.h says so. New
/// plans are those of `<plant>.plan.csv`. The rate limit is reached in a control period in which
/// the actuator turns by 0.98 or more of what its rate allows and ends away from its command;
/// periods less than 0.5 s apart are one event. A collision is at the first row whose clearance is
/// 0, and a roll-over when the car leans by more than 60 degrees, unless metrics.json has their
/// times (Recording::contact_time, roll_over_time); a roll-over begins as an event when the car
/// leans by more than 30 degrees for the last time before.
/// Cost: linear in the rows of the log, times the obstacles that are not known from the start.
std::vector<RunEvent> FindEvents(const Recording& recording);

/// When the planner learns of each of the world's obstacles [s]: -infinity where it is known from
/// the start, infinity where it never is.
std::vector<double> KnownFrom(const Recording& recording);

}  // namespace trackbed::render
