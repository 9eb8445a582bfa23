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

/// A plant, a controller and plans like those of a user, simple enough for results in closed form.
namespace trackbed {

inline constexpr double kUnicycleWheelbase = 2.0;  // [m]

/// Parameters of the unicycle. The unicycle is 4 m long and 2 m wide, so a tenth of its length is
/// 0.4 m.
inline VehicleParams UnicycleParams() {
  VehicleParams params;
  params.wheelbase = kUnicycleWheelbase;
  params.length = 4.0;
  params.width = 2.0;
  params.steering_limit = 1.0;
  params.steering_rate = 1.0;
  return params;
}

/// Obeys the acceleration exactly, turns its wheels to the commanded angle at once, and moves on an
/// arc of the exact length in each step. Like every plant, the unicycle never rolls against the
/// gear.
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
    // If the unicycle comes to rest within the step, it moves by v^2/(2 a).
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

  std::vector<Command> commands;  ///< commands of all steps
  double force = 0.0;             ///< contact force of obstacles [N]
  bool is_diverged = false;
  double gap = 0.0;  ///< wheel_gap [m]

 private:
  double timestep_;
  VehicleState state_;
};

/// Always commands the same steering angle, and the same acceleration if one is given.
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

  std::vector<VehicleState> inputs;  ///< states of all updates
  std::vector<double> stations;      ///< stations of all updates [m]

 private:
  double steering_;
  std::optional<double> acceleration_;
};

inline constexpr SpeedLimits kUnicycleLimits{
    .speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};

/// A plan along `segments` from the origin, with stops at the cusps and at the end.
inline Plan PlanAlongRoute(const std::vector<Segment>& segments, double start_speed) {
  Plan plan;
  plan.reference.path = Path({}, segments);
  plan.reference.speed = StopAtCusps(plan.reference.path, start_speed, kUnicycleLimits);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = plan.reference.path.At(plan.reference.path.length()).pose;
  return plan;
}

/// A plan without a path, at `speed` [m/s].
inline Plan PlanAtSpeed(double speed) {
  Plan plan;
  plan.reference.speed = SpeedProfile({{0.0, speed}});
  plan.schedule_speed = plan.reference.speed;
  return plan;
}

/// Converts any plan to a FeasiblePlan, even if it is infeasible.
inline FeasiblePlan Drivable(Plan plan) {
  PlanRequest request{};
  request.infeasible = InfeasiblePolicy::kAllow;
  return MakeFeasible(std::move(plan), request);
}

}  // namespace trackbed
