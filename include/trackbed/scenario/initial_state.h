#pragma once

#include "trackbed/planning/common/plan.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Returns the same initial state as InitialState(scenario), except for the steering angle at the
/// start of a path file, course, route over lanes or track. On a route of the mission, the wheels
/// start at the steering angle that matches the curvature at the start of the route, if this angle
/// is within the car's limit. If the mission or a recording sets the steering angle, the wheels
/// start at the set angle. For a route over lanes, InitialState repeats the search for the route.
StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle);

/// Returns the track and the laps of the mission; no track if the mission is not on a track.
TrackLaps TrackOf(const Scenario& scenario);

/// Returns the mission's route on the world's road network; empty if the world has no road network.
LaneMission LaneMissionOf(const Scenario& scenario);

}  // namespace trackbed
