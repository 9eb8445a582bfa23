#include "src/drive/termination.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Simulated time between a collision and the end of the run [s].
constexpr double kAfterCollision = 1.0;

/// Cosine of the largest permitted angle between the z axis of car or trailer and the vertical.
constexpr double kUpright = 0.5;

/// Returns whether the car leans by more than 60 degrees. An angle of 60 degrees is larger than any
/// slope on which a car can stand, and larger than any roll angle from which a car recovers.
bool HasRolledOver(const VehicleState& state) {
  return std::cos(state.roll) * std::cos(state.pitch) < kUpright;
}

// Longest permitted time of the car in the air, for example over a bump, and longest permitted
// unintended standstill [s].
constexpr double kMaxAirborneTime = 1.0;
constexpr double kMaxStandstillTime = 10.0;

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
      end_time_(std::min(config.time_limit, config.duration.value_or(config.time_limit))),
      wheel_radius_(config.vehicle.wheel_radius),
      vehicle_(config.vehicle),
      jackknife_angle_(config.trailer ? JackknifeAngle(*config.trailer, config.vehicle)
                                      : std::numeric_limits<double>::infinity()) {
  if (!plan.gates.empty()) {
    last_gate_ = plan.gates.back();
  }
}

std::optional<DriveStatus> Termination::Update(const LoopStatus& now) {
  if (now.contact_time) {
    end_time_ = std::min(end_time_, *now.contact_time + kAfterCollision);
  }
  if (const std::optional<DriveStatus> fault = Fault(now)) {
    return fault;
  }
  if (!now.interrupted && !now.contact_time && HasPassedCourse(now)) {
    return DriveStatus::kArrived;
  }
  const bool time_over = now.state.time >= end_time_ - half_timestep_;
  const bool stays = has_path_ && now.at_rest && !now.run_continues;
  if (now.interrupted || time_over || stays) {
    return StatusAtEnd(now);
  }
  return std::nullopt;
}

std::optional<DriveStatus> Termination::Fault(const LoopStatus& now) {
  if (now.plant.diverged()) {
    cause_ = now.plant.divergence();
    return DriveStatus::kDiverged;
  }
  constexpr double kDegrees = 180.0 / kPi;
  if (const std::optional<TrailerState> trailer = now.plant.trailer()) {
    if (std::abs(trailer->angle) >= jackknife_angle_) {
      cause_ = fmt::format(
          "at a hitch angle of {:.1f} deg, the trailer touches the car, which limits it to {:.1f} "
          "deg",
          trailer->angle * kDegrees, jackknife_angle_ * kDegrees);
      return DriveStatus::kJackknifed;
    }
    if (std::cos(trailer->lean) < kUpright) {
      cause_ = fmt::format("the trailer leans by {:.0f} deg", trailer->lean * kDegrees);
      return DriveStatus::kRolledOver;
    }
  }
  if (HasRolledOver(now.state)) {
    cause_ = fmt::format("roll {:.0f} deg, pitch {:.0f} deg", now.state.roll * kDegrees,
                         now.state.pitch * kDegrees);
    return DriveStatus::kRolledOver;
  }
  const double gap = now.plant.wheel_gap();
  if (gap < -wheel_radius_) {
    cause_ = fmt::format("a wheel reaches {:.3g} m below the road", -gap);
    return DriveStatus::kSunk;
  }
  if (gap <= wheel_radius_) {
    airborne_since_.reset();
  } else if (!airborne_since_) {
    airborne_since_ = now.state.time;
  } else if (now.state.time - *airborne_since_ > kMaxAirborneTime) {
    cause_ = fmt::format("all wheels are {:.3g} m or more above the road", gap);
    return DriveStatus::kAirborne;
  }
  const std::optional<double> since = standstill_.Update(now.state, now.to_move);
  if (since && now.state.time - *since > kMaxStandstillTime) {
    cause_ = fmt::format("has not moved since {:.2f} s, although it was to drive", *since);
    return DriveStatus::kStuck;
  }
  return std::nullopt;
}

DriveStatus Termination::StatusAtEnd(const LoopStatus& now) {
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
  if (now.at_rest) {
    cause_ = now.is_last_segment ? GoalError(now.state.pose, now.segment.goal) : "";
    return DriveStatus::kStopped;
  }
  return DriveStatus::kTimeLimit;
}

bool Termination::HasPassedCourse(const LoopStatus& now) const {
  if (!now.coasts || !last_gate_) {
    return false;
  }
  const OrientedBox& lane = last_gate_->lane;
  const auto corners = FootprintAt(vehicle_, now.state.pose).Corners();
  return std::all_of(corners.begin(), corners.end(), [&](const Vec2& corner) {
    return ToLocal(lane.center, corner).x() >= 0.5 * lane.length;
  });
}

bool Termination::HasArrived(const LoopStatus& now) const {
  if (!has_path_) {
    return end_time_ == duration_;
  }
  return now.at_rest && now.is_last_segment && GoalError(now.state.pose, now.segment.goal).empty();
}

std::string Termination::GoalError(const Pose2& pose, const Pose2& goal) const {
  const double distance = DistanceBetween(pose, goal);
  if (distance > goal_tolerance_) {
    return fmt::format("distance of {:.4g} m to the goal exceeds {:.4g} m", distance,
                       goal_tolerance_);
  }
  const double heading = AngleDifference(pose.yaw, goal.yaw);
  if (goal_heading_tolerance_ && std::abs(heading) > *goal_heading_tolerance_) {
    return fmt::format("heading error {:.4g} rad exceeds {:.4g} rad", heading,
                       *goal_heading_tolerance_);
  }
  return "";
}

}  // namespace trackbed
