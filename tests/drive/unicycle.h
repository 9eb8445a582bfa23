#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/sim/plant.h"

/// A plant, a controller and plans as a user would write them, small enough for closed forms.
namespace trackbed {

inline constexpr double kUnicycleWheelbase = 2.0;  // [m]

/// What the loop is told of it: 4 m by 2 m, so that 0.1 of its length is 0.4 m.
inline VehicleParams UnicycleParams() {
  VehicleParams params;
  params.wheelbase = kUnicycleWheelbase;
  params.length = 4.0;
  params.width = 2.0;
  params.steering_limit = 1.0;
  params.steering_rate = 1.0;
  return params;
}

/// Obeys the acceleration exactly, has its wheels where they are asked to be at once, and moves by
/// an arc of the exact length in each step. Like every plant it never rolls against the gear.
class Unicycle : public Plant {
 public:
  explicit Unicycle(const StartState& start, double timestep = 0.002) : timestep_(timestep) {
    state_.pose = start.pose;
    state_.speed = start.speed;
    state_.steering = state_.steering_actuator = start.steering;
  }

  void Step(const Command& command) override {
    commands.push_back(command);
    double along = command.gear * state_.speed;
    const double next = along + command.gear * command.acceleration * timestep_;
    // Where it comes to rest within the step, it has moved by v^2/(2 a).
    const double moved = next < 0.0 ? 0.5 * along * along / std::abs(command.acceleration)
                                    : 0.5 * (along + next) * timestep_;
    along = std::max(0.0, next);
    state_.steering = state_.steering_actuator = command.steering;
    const double curvature = std::tan(command.steering) / kUnicycleWheelbase;
    const double turn = command.gear * moved * curvature;
    const double chord =
        turn == 0.0 ? command.gear * moved : 2.0 * std::sin(0.5 * turn) / curvature;
    const Vec2 to = state_.pose.position() + chord * Direction(state_.pose.yaw + 0.5 * turn);
    state_.pose = {to.x(), to.y(), state_.pose.yaw + turn};
    state_.distance += moved;
    state_.speed = command.gear * along;
  }

  void ApplyLateralOffset(double left) override {
    const Vec2 to = ToWorld(state_.pose, {0.0, left});
    state_.pose.x = to.x();
    state_.pose.y = to.y();
  }
  void ApplyLateralForce(double /*force*/) override {}
  [[nodiscard]] VehicleState Observe() const override { return state_; }
  [[nodiscard]] Pose2 pose() const override { return state_.pose; }
  [[nodiscard]] double obstacle_force() const override { return force; }
  [[nodiscard]] std::vector<double> Configuration() const override {
    return {state_.pose.x, state_.pose.y};
  }
  [[nodiscard]] bool diverged() const override { return is_diverged; }
  [[nodiscard]] std::string divergence() const override { return "as asked for"; }
  [[nodiscard]] double wheel_gap() const override { return gap; }

  [[nodiscard]] VehicleState& state() { return state_; }

  std::vector<Command> commands;  ///< of every step
  double force = 0.0;             ///< of obstacles [N]
  bool is_diverged = false;
  double gap = 0.0;  ///< wheel_gap [m]

 private:
  double timestep_;
  VehicleState state_;
};

/// Always asks for the same angle, and for an acceleration if it has one.
class ConstantController : public SteeringController {
 public:
  explicit ConstantController(double steering, std::optional<double> acceleration = {})
      : steering_(steering), acceleration_(acceleration) {}

  double Steer(const ControlInput& input) override {
    inputs.push_back(input.state);
    stations.push_back(input.station);
    return steering_;
  }
  std::optional<double> Accelerate(const ControlInput& /*input*/) override { return acceleration_; }

  std::vector<VehicleState> inputs;  ///< that it was told, update by update
  std::vector<double> stations;      ///< likewise [m]

 private:
  double steering_;
  std::optional<double> acceleration_;
};

inline constexpr SpeedLimits kUnicycleLimits{
    .speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};

/// Along `segments` from the origin, at rest at its cusps and its end.
inline Plan PlanAlongRoute(const std::vector<Segment>& segments, double start_speed) {
  Plan plan;
  plan.reference.path = Path({}, segments);
  plan.reference.speed = StopAtCusps(plan.reference.path, start_speed, kUnicycleLimits);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = plan.reference.path.At(plan.reference.path.length()).pose;
  return plan;
}

/// Without a path, at `speed` [m/s].
inline Plan PlanAtSpeed(double speed) {
  Plan plan;
  plan.reference.speed = SpeedProfile({{0.0, speed}});
  plan.schedule_speed = plan.reference.speed;
  return plan;
}

/// Any plan as one that may be driven.
inline FeasiblePlan Drivable(Plan plan) {
  PlanRequest request{};
  request.infeasible = InfeasiblePolicy::kAllow;
  return MakeFeasible(std::move(plan), request);
}

}  // namespace trackbed
