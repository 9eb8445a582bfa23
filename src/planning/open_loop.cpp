#include "trackbed/planning/open_loop.h"

#include <algorithm>
#include <vector>

#include "trackbed/core/angle.h"

namespace trackbed {

OpenLoopDrive DriveOpenLoop(const VehicleParams& vehicle, const Path& path,
                            const SteeringSchedule& schedule, double stop_distance, double speed,
                            ReferencePoint reference) {
  constexpr double kSpacing = 0.5;  // [m]; deviations bend over metres
  std::vector<double> stations;
  for (double s = 0.0; s < stop_distance; s += kSpacing) {
    stations.push_back(s);
  }
  stations.push_back(stop_distance);
  const PathPoint first = path.At(0.0);
  const KinematicState start{.pose = first.pose, .speed = speed, .steering = schedule.At(0.0)};
  const auto states = RollOut(vehicle, start, schedule, stations, kSpacing, reference);
  OpenLoopDrive drive;
  double station = 0.0;
  for (const KinematicState& state : states) {
    const Projection at = path.Project(state.pose, {station - 2.0, station + 2.0});
    station = at.s;
    const double distance = (path.At(at.s).pose.position() - state.pose.position()).norm();
    drive.deviation_max = std::max(drive.deviation_max, distance);
  }
  const Pose2& end = states.back().pose;
  const Pose2 goal = path.At(path.length()).pose;
  drive.goal_distance = (end.position() - goal.position()).norm();
  drive.goal_heading = AngleDifference(end.yaw, goal.yaw);
  return drive;
}

nlohmann::json ToJson(const OpenLoopDrive& drive) {
  return {{"goal_distance_m", drive.goal_distance},
          {"goal_heading_error_rad", drive.goal_heading},
          {"deviation_max_m", drive.deviation_max}};
}

}  // namespace trackbed
