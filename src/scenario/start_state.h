#pragma once

#include <optional>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the road wheel angle at the start of the run [rad], which is also the angle of the
/// steering actuator. Returns nullopt if neither the mission nor a recording determines the initial
/// wheel angle.
std::optional<double> GivenSteering(const Scenario& scenario);

/// Returns the steering angle with which the plan's bicycle model drives straight ahead [rad]; 0
/// without a plan.
double NeutralSteering(const Scenario& scenario);

/// Returns the initial speed [m/s] if a source other than mission.speed defines the initial speed.
/// The sources of the initial speed are, in the order of their priority: mission.start.speed, a
/// recording with speeds, a recorded drive, the speeds of a followed path, and
/// control.speed.over_time. An initial speed from a followed path is limited to mission.speed.
std::optional<double> StartSpeedBesideMission(const Scenario& scenario);

/// Returns the initial state of the car, as InitialState does, before the route is known.
StartState StartOfMission(const Scenario& scenario);

}  // namespace trackbed
