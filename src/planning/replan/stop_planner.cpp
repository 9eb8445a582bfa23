#include "src/planning/replan/stop_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {
namespace {

/// Length below which a path is replaced by an empty path [m].
constexpr double kMinPathLength = 1e-3;
/// Distance before the place of a conflict at which a braking car stops [m].
constexpr double kBrakeRoom = 0.5;

std::string Place(const OrientedBox& box) {
  return fmt::format("({:.4g}, {:.4g})", box.center.x, box.center.y);
}

}  // namespace

bool Stands(const MovingBox& box) {
  return box.velocity.norm() < kStandstillSpeed;
}

std::optional<BrakingPlan> StopPlanner::StopBefore(const PredictedConflict& conflict,
                                                   double speed) const {
  const MovingBox& obstacle = request_.obstacles[conflict.obstacle];
  const double room = conflict.station - driving_.station - kBrakeRoom;
  const double braking = Stands(obstacle) ? BrakingWithin(room, speed) : BrakingFor(speed);
  const double shortest = speed * speed / (2.0 * braking);
  const bool comfortable = braking <= ComfortableBraking();
  // For a static obstacle, brake as late as comfortable braking allows. For a moving obstacle,
  // brake at once, because the obstacle may come closer.
  const double way = Stands(obstacle) && comfortable ? std::max(shortest, room) : shortest;
  const double left = driving_.plan.reference.path.length() - driving_.station;
  if (way < kMinPathLength && left < kMinPathLength) {
    return std::nullopt;
  }
  Plan stop = StopAfter(way, speed, comfortable);
  if (!Stands(obstacle) && !DelaysConflict(stop, conflict)) {
    return std::nullopt;
  }
  stop.goal = driving_.route.goal;
  stop.blocked =
      fmt::format("stops before the obstacle at {}: no path around it", Place(obstacle.box));
  return BrakingPlan{std::move(stop), braking};
}

std::optional<PredictedConflict> StopPlanner::FirstConflict(const Plan& plan) const {
  return PredictConflict(request_.vehicle, plan.reference, 0.0, request_.obstacles,
                         options_.settings.safe_distance, options_.settings.look_ahead);
}

bool StopPlanner::DelaysConflict(const Plan& plan, const PredictedConflict& conflict) const {
  const auto braked = FirstConflict(plan);
  return !braked || braked->time >= conflict.time;
}

double StopPlanner::HardestBraking() const {
  return request_.max_deceleration > 0.0 ? request_.max_deceleration : request_.speed.deceleration;
}

double StopPlanner::ComfortableBraking() const {
  return std::min(request_.speed.deceleration, HardestBraking());
}

double StopPlanner::BrakingWithin(double room, double speed) const {
  const double needed = 0.5 * speed * speed / std::max(room, kMinPathLength);
  return std::min(std::max(needed, ComfortableBraking()), HardestBraking());
}

double StopPlanner::BrakingFor(double speed) const {
  const double hardest = HardestBraking();
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const double braking =
        std::lerp(ComfortableBraking(), hardest, static_cast<double>(i) / kSteps);
    const Plan plan = StopAfter(0.5 * speed * speed / braking, speed, i == 0);
    if (!FirstConflict(plan)) {
      return braking;
    }
  }
  return hardest;
}

Plan StopPlanner::StopAfter(double way, double speed, bool comfortable) const {
  const Path& path = driving_.plan.reference.path;
  const double from = driving_.station;
  const double shortest = 0.5 * speed * speed / ComfortableBraking();
  double to = from + way;
  if (comfortable && to > path.length()) {
    to = std::max(path.length(), from + shortest);
  }
  Plan plan;
  plan.reference.path =
      Path(path.At(from).pose,
           to - from < kMinPathLength ? std::vector<Segment>{} : SegmentsBetween(path, {from, to}));
  const Path& own = plan.reference.path;
  // A plan with hard braking needs no speed caps, because the car already slows down as fast as
  // it can.
  plan.caps =
      comfortable ? Moved(CapsOf(driving_.plan), {from, to}, -from) : std::vector<SpeedCap>{};
  SpeedLimits limits = request_.speed;
  limits.deceleration = ComfortableBraking();
  plan.reference.speed = StopAtEnd(own.length(), speed, limits, plan.caps);
  // For a sampled motion, use the steering angles at the samples, because the path's curvature
  // between samples may change faster than the wheels can turn.
  plan.sampled = driving_.plan.sampled;
  plan.schedule =
      plan.sampled && own.length() > 0.0
          ? SteeringSchedule::Through(SteeringBetween(driving_.plan.schedule, {from, to}))
      : own.length() > 0.0 ? CourseSchedule(request_.vehicle, own.segments(),
                                            std::max(request_.speed.speed, speed), plan.caps)
                           : SteeringSchedule::Constant(
                                 SteeringForCurvature(request_.vehicle, path.At(from).curvature));
  plan.schedule_speed = plan.reference.speed;
  return plan;
}

}  // namespace trackbed
