#include "src/drive/collision_watch.h"

#include <algorithm>

namespace trackbed {

CollisionWatch::CollisionWatch(const World& world, const VehicleParams& vehicle)
    : world_(world), vehicle_(vehicle) {}

void CollisionWatch::Update(const Plant& plant, double time) {
  if (!HasObstacles(world_)) {
    return;
  }
  const Pose2 pose = plant.pose();
  const double clearance = *Clearance(world_, vehicle_, pose, time);
  if (pose_) {
    const ClosestApproach between =
        ApproachBetween(world_, vehicle_, {*pose_, time_, clearance_}, {pose, time, clearance});
    Note(between.clearance, between.time);
  }
  Note(clearance, time);
  const double force = plant.obstacle_force();
  period_.force = std::max(period_.force, force);
  if (force > 0.0) {
    // a car that rolls or pitches may touch an obstacle that lies outside the footprint
    Note(0.0, time);
  }
  pose_ = pose;
  time_ = time;
  clearance_ = clearance;
}

CollisionWatch::Period CollisionWatch::Take() {
  Period taken = period_;
  period_ = {};
  if (pose_) {
    period_.clearance = clearance_;
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
