#pragma once

#include <optional>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Bicycle angle of the wheels on the straights of the plan [rad]; 0 without a plan.
double NeutralSteering(const Scenario& scenario);

/// Initial speed [m/s] if mission.speed does not define it. The first available of
/// mission.start.speed, a recording with speeds, a record, a path followed at its own speeds, and
/// control.speed.over_time.
std::optional<double> StartSpeedBesideMission(const Scenario& scenario);

}  // namespace trackbed
