#include "trackbed/scenario/initial_state.h"

#include <algorithm>

#include "src/scenario/start_state.h"
#include "trackbed/control/playback.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/track/track.h"

// Initial state of a run, shared by planners, plants and the resolved scenario.
namespace trackbed {
namespace {

/// The first recorded sample; null without a record.
const RecordedSample* FirstSample(const Scenario& scenario) {
  return scenario.record && scenario.record->data ? &scenario.record->data->samples.front()
                                                  : nullptr;
}

/// The path from a file that the plan follows; null for other plans.
const FittedPath* PathOfFile(const Scenario& scenario) {
  const auto* own = scenario.plan ? scenario.plan->global.As<PathFileOptions>() : nullptr;
  return own == nullptr ? nullptr : own->path.get();
}

Pose2 StartPose(const Scenario& scenario) {
  const MissionSpec& mission = scenario.mission;
  const RecordedSample* recorded = FirstSample(scenario);
  const FittedPath* path = PathOfFile(scenario);
  Pose2 pose = path != nullptr       ? path->path.At(0.0).pose
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
      WhyNoPlace(roads->data->network, mission.route.front()).empty()) {
    pose = PoseAt(roads->data->network, mission.route.front());
  }
  const StartSpec& given = mission.start;
  return {given.x.value_or(pose.x), given.y.value_or(pose.y), given.yaw.value_or(pose.yaw)};
}

/// Initial angle of the road wheels and of the actuator [rad].
double StartSteering(const Scenario& scenario) {
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
  if (const RecordedSample* recorded = FirstSample(scenario)) {
    return std::max(0.0, recorded->velocity_V.x());
  }
  if (const FittedPath* path = PathOfFile(scenario)) {
    const auto& options = scenario.plan->global.Get<PathFileOptions>();
    if (options.speeds == PathSpeeds::kFile && !path->given.speed.empty()) {
      return path->given.speed.front();
    }
  }
  const Signal& over_time = scenario.control.speed.over_time;
  return over_time.empty() ? std::nullopt : std::optional(over_time.At(0.0));
}

StartState InitialState(const Scenario& scenario) {
  StartState start{.pose = StartPose(scenario),
                   .speed = StartSpeedBesideMission(scenario).value_or(scenario.mission.speed),
                   .steering = StartSteering(scenario)};
  const RecordedSample* recorded = FirstSample(scenario);
  if (recorded != nullptr) {
    const StartState own = StartFrom(*recorded, start.steering);
    // The recorded sideslip only applies at the recorded speed.
    if (start.speed == own.speed) {
      start.lateral_speed = own.lateral_speed;
      start.yaw_rate = own.yaw_rate;
    }
  }
  return start;
}

StartState InitialState(const Scenario& scenario, const VehicleParams& vehicle) {
  StartState start = InitialState(scenario);
  const FittedPath* path = PathOfFile(scenario);
  if (path != nullptr && !scenario.mission.start.steering) {
    start.steering = std::clamp(SteeringForCurvature(vehicle, path->path.At(0.0).curvature),
                                -vehicle.steering_limit, vehicle.steering_limit);
  }
  return start;
}

}  // namespace trackbed
