#pragma once

#include <optional>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the steering angle of the bicycle model on the straights of the plan [rad]; 0 without a
/// plan.
double NeutralSteering(const Scenario& scenario);

/// Returns the initial speed [m/s] if a source other than mission.speed defines the initial speed.
/// The first available source is used: mission.start.speed, a recording with speeds, a recorded
/// drive, a path followed at its own speeds, control.speed.over_time.
std::optional<double> StartSpeedBesideMission(const Scenario& scenario);

}  // namespace trackbed
