#pragma once

#include <optional>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Wheel angle of the bicycle model on the plan's straights [rad]; 0 without a plan.
double NeutralSteering(const Scenario& scenario);

/// Initial speed if mission.speed does not define the speed [m/s]. The initial speed is the first
/// available of mission.start.speed, a recording with speeds, a record, a path followed at its own
/// speeds, and control.speed.over_time.
std::optional<double> StartSpeedBesideMission(const Scenario& scenario);

}  // namespace trackbed
