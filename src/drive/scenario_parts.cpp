#include "src/drive/scenario_parts.h"

namespace trackbed {

SpeedLimits MakeSpeedLimits(const Scenario& scenario) {
  const SpeedControlOptions& speed = scenario.control.speed;
  return {MissionSpeed(scenario), speed.acceleration, speed.deceleration};
}

ReplanningConfig MakeReplanningConfig(const Scenario& scenario) {
  return {.avoid = scenario.plan->avoid,
          .replan = scenario.plan->replan,
          .limits = MakeSpeedLimits(scenario),
          .infeasible = scenario.plan->infeasible};
}

}  // namespace trackbed
