#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// An event in a run.
struct RunEvent {
  enum class Kind {
    kObstacleKnown,  ///< the planner detects an obstacle that was there before
    kNewPlan,        ///< the car adopts a new plan
    kRateLimit,      ///< the steering is at its rate limit, away from its command
    kCollision,      ///< first contact with an obstacle
    kRollOver,       ///< the car tips over
  };
  Kind kind = Kind::kNewPlan;
  double from = 0;    ///< [s]
  double to = 0;      ///< end of the event [s]; equals `from` if it has no duration
  Point place;        ///< position of the car's rear axle at its start, on the ground
  std::string text;   ///< message
  int obstacle = -1;  ///< index, for kObstacleKnown
};

/// The events of the recorded car, `recording.plants.front()`, in order of time.
///
/// An obstacle becomes known in the first control period in which IsKnown of world.h is true. New
/// plans are those of `<plant>.plan.csv`. The rate limit is reached in a control period in which
/// the actuator turns by at least 0.98 of its maximum and does not reach its command; periods less
/// than 0.5 s apart are one event. A collision is at the first row with clearance 0, and a
/// roll-over when the car leans by more than 60 degrees, unless metrics.json has their times
/// (Recording::contact_time, roll_over_time). A roll-over starts when the car last exceeds a lean
/// of 30 degrees before. Cost: linear in the rows of the log, times the obstacles not known from
/// the start.
std::vector<RunEvent> FindEvents(const Recording& recording);

/// Time at which the planner detects each of the world's obstacles [s]: -infinity if it is known
/// from the start, infinity if it is never detected.
std::vector<double> KnownFrom(const Recording& recording);

}  // namespace trackbed::render
