#include "trackbed/scenario/maneuver.h"

#include "trackbed/core/error.h"

namespace trackbed {

const std::vector<ManeuverEntry>& Maneuvers() {
  static const std::vector<ManeuverEntry> table{
      {"steady_state_circle", "understeer, roll and sideslip gradients (ISO 4138)",
       SteadyStateCircleOptions{}},
      {"slowly_increasing_steer",
       "the same gradients from a slow steering ramp at constant speed (SAE J266)",
       SlowlyIncreasingSteerOptions{}},
      {"step_steer", "response to a step of the steering (ISO 7401)", StepSteerOptions{}},
      {"sine_with_dwell", "stability and responsiveness (ISO 19365, FMVSS 126)",
       SineWithDwellTestOptions{}},
      {"lane_change", "margins to the gates of a double lane change (ISO 3888)",
       LaneChangeOptions{}},
      {"braking", "braking distance, deceleration and course deviation (ISO 21994, ISO 7975)",
       BrakingTestOptions{}},
      {"disturbance", "course deviation and recovery after a disturbance", DisturbanceOptions{}},
  };
  return table;
}

const char* ManeuverName(const ManeuverOptions& options) {
  for (const ManeuverEntry& entry : Maneuvers()) {
    if (entry.defaults.index() == options.index()) {
      return entry.name;
    }
  }
  throw InternalError("options of a maneuver that is not in the table");
}

}  // namespace trackbed
