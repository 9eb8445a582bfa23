#include "trackbed/planning/common/open_loop.h"

#include <algorithm>
#include <vector>

#include "trackbed/core/angle.h"

namespace trackbed {

OpenLoopRun SimulateOpenLoop(const VehicleParams& vehicle, const Path& path,
                             const SteeringSchedule& schedule, double stop_distance,
                             ReferencePoint reference) {
  // Distance between recorded deviations [m]; small enough, because deviations change slowly over
  // several meters.
  constexpr double kSpacing = 0.5;
  // Integration step of the simulation [m]; the integration error is of fourth order.
  constexpr double kStep = 0.05;
  constexpr double kSearch = 2.0;  // [m]
  OpenLoopRun drive;
  KinematicState state{.pose = path.At(0.0).pose};
  const std::vector<Stations> legs = SplitIntoLegs(path);
  for (const Stations& leg : legs) {
    const double end = &leg == &legs.back() ? std::max(stop_distance, leg.from) : leg.to;
    state.speed = path.At(0.5 * (leg.from + leg.to)).direction;
    std::vector<double> distances;
    for (double d = kSpacing; d < end - leg.from; d += kSpacing) {
      distances.push_back(d);
    }
    distances.push_back(end - leg.from);
    double station = leg.from;
    for (const KinematicState& at :
         RollOut(vehicle, state, schedule.From(leg.from), distances, kStep, reference)) {
      station = path.Project(at.pose, {std::max(station - kSearch, leg.from),
                                       std::max(std::min(station + kSearch, leg.to), leg.from)})
                    .s;
      const double distance = (path.At(station).pose.position() - at.pose.position()).norm();
      drive.deviation_max = std::max(drive.deviation_max, distance);
      state = at;
    }
  }
  const Pose2 goal = path.At(path.length()).pose;
  drive.goal_distance = (state.pose.position() - goal.position()).norm();
  drive.goal_heading = AngleDifference(state.pose.yaw, goal.yaw);
  return drive;
}

void Visit(DiagnosticsVisitor& out, const OpenLoopRun& drive) {
  out.Number("goal_distance_m", drive.goal_distance);
  out.Number("goal_heading_error_rad", drive.goal_heading);
  out.Number("deviation_max_m", drive.deviation_max);
}

}  // namespace trackbed
