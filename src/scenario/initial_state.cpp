#include "trackbed/scenario/initial_state.h"

#include <cmath>

#include "src/scenario/start_state.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"

// Determines the initial state of the car in a run. Planners, plants and the resolved scenario use
// the initial state that InitialState returns.
namespace trackbed {
namespace {

/// Returns the steering angle with which the planner's route begins [rad]. Returns nullopt if the
/// planner follows no given route, or if this steering angle exceeds the car's steering limit.
std::optional<double> RouteSteering(const Scenario& scenario, const VehicleParams& vehicle,
                                    const Pose2& start) {
  if (!scenario.plan) {
    return std::nullopt;
  }
  const PlannerOptions& options = scenario.plan->global;
  const PlannerEntry& planner = PlannerFor(options);
  if (planner.start_curvature == nullptr) {
    return std::nullopt;
  }
  const std::optional<double> curvature = planner.start_curvature(
      options, {.pose = start, .on_track = TrackOf(scenario), .lanes = LaneMissionOf(scenario)});
  const double steering = SteeringForCurvature(vehicle, curvature.value_or(0.0));
  return curvature && std::abs(steering) <= vehicle.steering_limit ? std::optional(steering)
                                                                   : std::nullopt;
}

}  // namespace

TrackLaps TrackOf(const Scenario& scenario) {
  const std::optional<TrackSpec>& track = scenario.mission.track;
  return track ? TrackLaps{track->data, track->laps} : TrackLaps{};
}

LaneMission LaneMissionOf(const Scenario& scenario) {
  const auto& roads = scenario.world.road_network;
  return roads && roads->data
             ? LaneMission{{roads->data, &roads->data->network}, scenario.mission.route}
             : LaneMission{};
}

StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle) {
  StartState start = InitialState(scenario);
  if (!GivenSteering(scenario)) {
    start.steering = RouteSteering(scenario, vehicle, start.pose).value_or(start.steering);
  }
  return start;
}

}  // namespace trackbed
