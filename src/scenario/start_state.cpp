#include "src/scenario/start_state.h"

#include "trackbed/control/playback.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/fillet/fillet.h"

// How a run begins, for planners, plants and the resolved scenario alike.
namespace trackbed {
namespace {

Pose2 StartPose(const MissionSpec& mission) {
  Pose2 pose = StartOfRoute(mission.waypoints);
  if (!mission.headings.empty()) {
    pose.yaw = mission.headings.front();
  }
  const StartSpec& given = mission.start;
  return {given.x.value_or(pose.x), given.y.value_or(pose.y), given.yaw.value_or(pose.yaw)};
}

/// Of wheels and actuator [rad].
double StartSteering(const Scenario& scenario) {
  if (const std::optional<double>& given = scenario.mission.start.steering) {
    return *given;
  }
  const Recording* recording = FindRecording(scenario);
  if (recording != nullptr && scenario.drive.steering == SteeringInput::kPrescribed) {
    return recording->steering.At(0.0);
  }
  const auto* fillets = scenario.plan ? scenario.plan->global.As<FilletOptions>() : nullptr;
  return fillets == nullptr ? 0.0 : fillets->neutral_steering;
}

}  // namespace

std::optional<double> StartSpeedBesideMission(const Scenario& scenario) {
  if (scenario.mission.start.speed) {
    return scenario.mission.start.speed;
  }
  const Recording* recording = FindRecording(scenario);
  if (recording != nullptr && !recording->speed.empty()) {
    return recording->speed.At(0.0);
  }
  const Signal& over_time = scenario.control.speed.over_time;
  return over_time.empty() ? std::nullopt : std::optional(over_time.At(0.0));
}

StartState InitialState(const Scenario& scenario) {
  return {.pose = StartPose(scenario.mission),
          .speed = StartSpeedBesideMission(scenario).value_or(scenario.mission.speed),
          .steering = StartSteering(scenario)};
}

}  // namespace trackbed
