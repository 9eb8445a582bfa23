#include "src/drive/loop_surroundings.h"

#include <algorithm>
#include <cmath>

#include "trackbed/track/track.h"

namespace trackbed {

LoopSurroundings::LoopSurroundings(const World& world, const VehicleParams& vehicle)
    : world_(&world), vehicle_(&vehicle), known_(world.obstacles.size(), false) {}

void LoopSurroundings::BeginPeriod(const VehicleState& state, const Plan& plan) {
  state_ = state;
  plan_ = &plan;
  sees_ = false;
  if (known_.empty()) {
    return;
  }
  const OrientedBox footprint = FootprintAt(*vehicle_, state.pose);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    known_[i] = known_[i] || IsKnown(world_->obstacles[i], state.time, footprint);
  }
}

const std::vector<SeenObstacle>& LoopSurroundings::Obstacles() const {
  if (sees_) {
    return seen_;
  }
  const std::vector<OrientedBox>& walls = MapWalls(*world_);
  if (seen_.size() < walls.size()) {
    seen_.clear();
    for (const OrientedBox& wall : walls) {
      seen_.push_back({.footprint = wall});
    }
  }
  seen_.resize(walls.size());
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (known_[i]) {
      const Obstacle& obstacle = world_->obstacles[i];
      const ObstacleMotion motion = MotionAt(obstacle, state_.time);
      seen_.push_back({.footprint = FootprintAt(obstacle, state_.time),
                       .velocity = motion.velocity,
                       .yaw_rate = motion.yaw_rate});
    }
  }
  sees_ = true;
  return seen_;
}

const PathEdges& LoopSurroundings::Edges() const {
  if (edges_) {
    return *edges_;
  }
  edges_.emplace();
  const Path& path = plan_->reference.path;
  if (plan_->laps.track && path.length() > 0.0) {
    constexpr double kSpacing = 0.5;  // [m]
    const Track& track = *plan_->laps.track;
    const double count = std::max(std::ceil(path.length() / kSpacing), 1.0);
    edges_->spacing = path.length() / count;
    std::optional<double> near;
    for (double i = 0.0; i <= count; i += 1.0) {
      const Vec2 point = path.At(i * edges_->spacing).pose.position();
      const TrackPlace place = track.Locate(point, near);
      near = place.s;
      const TrackEdges edges = track.EdgesAt(place.s);
      edges_->distances.push_back(
          {.left = edges.left - place.offset, .right = place.offset - edges.right});
    }
  }
  return *edges_;
}

double LoopSurroundings::RoadFriction() const {
  return RoadFactor(*world_, state_.pose.position());
}

}  // namespace trackbed
