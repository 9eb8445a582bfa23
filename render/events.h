#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/recording.h"

namespace trackbed::render {

/// An event of a run that a film shows.
struct RunEvent {
  enum class Kind {
    kObstacleKnown,  ///< The planner detects an obstacle that was unknown at the start of the run.
    kNewPlan,        ///< The car adopts a new plan.
    kRateLimit,      ///< The steering moves at its rate limit without reaching its command.
    kCollision,      ///< The car touches an obstacle for the first time.
    kRollOver,       ///< The car tips over.
  };
  Kind kind = Kind::kNewPlan;
  double from = 0;   ///< Start of the event [s].
  double to = 0;     ///< End of the event [s]; equals `from` for an event without duration.
  Point place;       ///< Position of the car's rear axle at the event's start, on the ground.
  std::string text;  ///< Text about the event that the film shows.
  /// Index of the obstacle that is detected, for events of kind kObstacleKnown.
  int obstacle = -1;
};

/// Returns the events of the recorded car, `recording.plants.front()`, in order of time.
///
/// An obstacle becomes known in the first control period in which IsKnown of world.h is true. New
/// plans of the car are read from `<plant>.plan.csv`. The steering is at its rate limit in a
/// control period if the actuator turns at 0.98 or more of its maximum rate and does not reach its
/// command. Periods at the rate limit that are less than 0.5 s apart are merged into one event. A
/// collision occurs at the first row of the log with clearance 0, and a roll-over when the car
/// leans by more than 60 degrees. If metrics.json contains the times of collision and roll-over,
/// these times are used (Recording::contact_time, roll_over_time). The event of a roll-over starts
/// when the car exceeds a lean of 30 degrees for the last time before tipping over. The run time of
/// FindEvents is proportional to the number of log rows times the number of obstacles not known
/// from the start.
std::vector<RunEvent> FindEvents(const Recording& recording);

/// Returns for each obstacle of the world the time at which the planner detects the obstacle [s].
/// The time of detection is -infinity for an obstacle known from the start, and infinity for an
/// obstacle that is never detected.
std::vector<double> KnownFrom(const Recording& recording);

}  // namespace trackbed::render
