#include "src/drive/collision_watch.h"

#include <algorithm>

namespace trackbed {

CollisionWatch::CollisionWatch(const World& world, const VehicleParams& vehicle,
                               const std::optional<TrailerParams>& trailer)
    : world_(world),
      car_{.shape = vehicle},
      trailer_(trailer),
      towed_{.shape = trailer ? TrailerBody(*trailer) : VehicleParams{}} {}

void CollisionWatch::Update(const Plant& plant, double time) {
  if (!HasObstacles(world_)) {
    return;
  }
  const Pose2 pose = plant.pose();
  Update(car_, pose, time);
  if (trailer_) {
    if (const std::optional<TrailerState> state = plant.trailer()) {
      Update(towed_, TrailerPose(*trailer_, pose, state->angle), time);
    }
  }
  const double force = plant.obstacle_force();
  period_.force = std::max(period_.force, force);
  if (force > 0.0) {
    // a car that rolls or pitches may touch an obstacle that lies outside the footprint
    Note(0.0, time);
  }
}

void CollisionWatch::Update(Body& body, const Pose2& pose, double time) {
  const double clearance = *Clearance(world_, body.shape, pose, time);
  if (body.last) {
    const ClosestApproach between =
        ApproachBetween(world_, body.shape, *body.last, {pose, time, clearance});
    Note(between.clearance, between.time);
  }
  Note(clearance, time);
  body.last = {pose, time, clearance};
}

CollisionWatch::Period CollisionWatch::Take() {
  Period taken = period_;
  period_ = {};
  for (const Body* body : {&car_, &towed_}) {
    if (body->last) {
      const double clearance = body->last->clearance;
      period_.clearance = std::min(period_.clearance.value_or(clearance), clearance);
    }
  }
  return taken;
}

void CollisionWatch::Note(double clearance, double time) {
  period_.clearance = std::min(period_.clearance.value_or(clearance), clearance);
  if (clearance == 0.0 && !contact_time_) {
    contact_time_ = time;
  }
}

}  // namespace trackbed
