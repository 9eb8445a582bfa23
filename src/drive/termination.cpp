#include "src/drive/termination.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// How long a collision is followed before the run ends [s].
constexpr double kAfterCollision = 1.0;

/// Beyond any slope that a car stands on, and any lean that it comes back from.
bool HasRolledOver(const VehicleState& state) {
  constexpr double kUpright = 0.5;  // cosine of the angle from the vertical
  return std::cos(state.roll) * std::cos(state.pitch) < kUpright;
}

double DistanceBetween(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

}  // namespace

bool IsAtRest(const VehicleState& state, const Command& command) {
  return std::abs(state.speed) < kAtRestSpeed && command.acceleration * command.gear <= 0.0;
}

Termination::Termination(const LoopConfig& config, const Plan& plan)
    : has_path_(plan.reference.path.length() > 0.0),
      is_partial_(!plan.partial.empty()),
      goal_tolerance_(config.goal_tolerance * config.vehicle.length),
      goal_heading_tolerance_(config.goal_heading_tolerance),
      duration_(config.duration),
      half_timestep_(0.5 * config.timestep),
      end_time_(std::min(config.time_limit, config.duration.value_or(config.time_limit))) {}

std::optional<DriveStatus> Termination::Update(const LoopStatus& now) {
  if (now.contact_time) {
    end_time_ = std::min(end_time_, *now.contact_time + kAfterCollision);
  }
  if (now.diverged) {
    return DriveStatus::kDiverged;
  }
  if (HasRolledOver(now.state)) {
    return DriveStatus::kRolledOver;
  }
  const bool time_over = now.state.time >= end_time_ - half_timestep_;
  const bool stays = has_path_ && now.at_rest && !now.will_go_on;
  if (now.interrupted || time_over || stays) {
    return StatusAtEnd(now);
  }
  return std::nullopt;
}

DriveStatus Termination::StatusAtEnd(const LoopStatus& now) const {
  const Path& path = now.segment.reference.path;
  if (now.interrupted) {
    return DriveStatus::kInterrupted;
  }
  if (now.contact_time) {
    return DriveStatus::kCollided;
  }
  if (now.at_rest && !now.segment.blocked.empty()) {
    return DriveStatus::kBlocked;
  }
  if (now.at_rest && is_partial_ &&
      DistanceBetween(now.state.pose, path.At(path.length()).pose) <= goal_tolerance_) {
    return DriveStatus::kPartial;
  }
  if (HasArrived(now)) {
    return DriveStatus::kArrived;
  }
  return now.at_rest ? DriveStatus::kStopped : DriveStatus::kTimeLimit;
}

bool Termination::HasArrived(const LoopStatus& now) const {
  if (!has_path_) {
    return end_time_ == duration_;
  }
  const Pose2& goal = now.segment.goal;
  const bool heading_fits =
      !goal_heading_tolerance_ ||
      std::abs(AngleDifference(now.state.pose.yaw, goal.yaw)) <= *goal_heading_tolerance_;
  return now.at_rest && now.is_last_segment && heading_fits &&
         DistanceBetween(now.state.pose, goal) <= goal_tolerance_;
}

}  // namespace trackbed
