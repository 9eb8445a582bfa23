#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// An event in a run.
struct RunEvent {
  enum class Kind {
    kObstacleKnown,  ///< The planner detects an obstacle that existed before.
    kNewPlan,        ///< The car adopts a new plan.
    kRateLimit,      ///< The steering moves at its rate limit without reaching its command.
    kCollision,      ///< First contact with an obstacle.
    kRollOver,       ///< The car tips over.
  };
  Kind kind = Kind::kNewPlan;
  double from = 0;    ///< Start of the event [s].
  double to = 0;      ///< End of the event [s]; equals `from` for an event without duration.
  Point place;        ///< Position of the car's rear axle at the event's start, on the ground.
  std::string text;   ///< Message of the event.
  int obstacle = -1;  ///< Index of the obstacle, for kObstacleKnown.
};

/// The events of the recorded car, `recording.plants.front()`, in order of time.
///
/// An obstacle becomes known in the first control period in which IsKnown of world.h is true. New
/// plans are those of `<plant>.plan.csv`. The rate limit is reached in a control period in which
/// the actuator turns by at least 0.98 of its maximum and misses its command. Periods at the rate
/// limit that are less than 0.5 s apart are one event. A collision is at the first row with
/// clearance 0, and a roll-over when the car leans by more than 60 degrees. Times in metrics.json
/// take precedence (Recording::contact_time, roll_over_time). The event of a roll-over starts where
/// the car, before tipping over, last exceeds a lean of 30 degrees. Cost of FindEvents: linear in
/// the rows of the log, times the obstacles not known from the start.
std::vector<RunEvent> FindEvents(const Recording& recording);

/// Time at which the planner detects each of the world's obstacles [s]. The time is -infinity for
/// an obstacle known from the start, and infinity for one that is never detected.
std::vector<double> KnownFrom(const Recording& recording);

}  // namespace trackbed::render
