#include "src/scenario/start_state.h"

#include <algorithm>

#include "trackbed/control/playback.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/track/track.h"

// Determines the initial state of the car from the mission, a recording or the planner.
namespace trackbed {
namespace {

/// Returns the first sample of the scenario's recorded drive; a null pointer if there is no
/// recorded drive.
const RecordedSample* FirstSample(const Scenario& scenario) {
  return scenario.record && scenario.record->data ? &scenario.record->data->samples.front()
                                                  : nullptr;
}

/// Returns the state of the car at the start of the plan, if the planner determines this state.
/// For most planners, returns no state, because their plans begin at the start of the mission.
std::optional<PlannedStart> StartOfPlan(const Scenario& scenario) {
  if (!scenario.plan) {
    return std::nullopt;
  }
  const PlannerOptions& options = scenario.plan->global;
  const PlannerEntry& planner = PlannerFor(options);
  return planner.start != nullptr ? planner.start(options) : std::nullopt;
}

Pose2 StartPose(const Scenario& scenario) {
  const MissionSpec& mission = scenario.mission;
  const RecordedSample* recorded = FirstSample(scenario);
  const std::optional<PlannedStart> planned = StartOfPlan(scenario);
  Pose2 pose = planned               ? planned->pose
               : recorded != nullptr ? recorded->pose
                                     : StartOfRoute(mission.waypoints);
  if (!mission.headings.empty()) {
    pose.yaw = mission.headings.front();
  }
  if (mission.track && mission.track->data) {
    pose = mission.track->data->At(0.0).pose;
  }
  const auto& roads = scenario.world.road_network;
  if (roads && roads->data && !mission.route.empty() &&
      LanePlaceError(roads->data->network, mission.route.front()).empty()) {
    pose = PoseAt(roads->data->network, mission.route.front());
  }
  const StartSpec& given = mission.start;
  return {given.x.value_or(pose.x), given.y.value_or(pose.y), given.yaw.value_or(pose.yaw)};
}

}  // namespace

std::optional<double> GivenSteering(const Scenario& scenario) {
  if (const std::optional<double>& given = scenario.mission.start.steering) {
    return *given;
  }
  const Recording* recording = FindRecording(scenario);
  if (recording != nullptr && scenario.drive.steering == SteeringInput::kPrescribed) {
    return recording->steering.At(0.0);
  }
  if (const RecordedSample* recorded = FirstSample(scenario)) {
    return scenario.record->steering == ReplaySteering::kMeasured ? recorded->steering
                                                                  : recorded->steering_command;
  }
  return std::nullopt;
}

double NeutralSteering(const Scenario& scenario) {
  if (!scenario.plan) {
    return 0.0;
  }
  const PlannerOptions& options = scenario.plan->global;
  const PlannerEntry& planner = PlannerFor(options);
  return planner.neutral_steering != nullptr ? planner.neutral_steering(options) : 0.0;
}

std::optional<double> StartSpeedBesideMission(const Scenario& scenario) {
  if (scenario.mission.start.speed) {
    return scenario.mission.start.speed;
  }
  const Recording* recording = FindRecording(scenario);
  if (recording != nullptr && !recording->speed.empty()) {
    return recording->speed.At(0.0);
  }
  if (const RecordedSample* recorded = FirstSample(scenario)) {
    return std::max(0.0, recorded->velocity_V.x());
  }
  if (const std::optional<PlannedStart> planned = StartOfPlan(scenario);
      planned && planned->speed) {
    const double most = scenario.mission.speed;
    return most > 0.0 ? std::min(*planned->speed, most) : *planned->speed;
  }
  const Signal& over_time = scenario.control.speed.over_time;
  return over_time.empty() ? std::nullopt : std::optional(over_time.At(0.0));
}

StartState StartOfMission(const Scenario& scenario) {
  StartState start{.pose = StartPose(scenario),
                   .speed = StartSpeedBesideMission(scenario).value_or(scenario.mission.speed),
                   .steering = GivenSteering(scenario).value_or(NeutralSteering(scenario)),
                   .hitch_angle = scenario.mission.start.hitch_angle.value_or(0.0)};
  const RecordedSample* recorded = FirstSample(scenario);
  if (recorded != nullptr) {
    const StartState own = StartFrom(*recorded, start.steering);
    // Use the recorded lateral speed and yaw rate only if the car starts at the recorded speed.
    if (start.speed == own.speed) {
      start.lateral_speed = own.lateral_speed;
      start.yaw_rate = own.yaw_rate;
    }
  }
  return start;
}

}  // namespace trackbed
