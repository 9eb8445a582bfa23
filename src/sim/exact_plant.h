#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

/// Returns the parameters of the car for a plant that follows its commands exactly. If the setup
/// prescribes the wheel angle, the returned parameters have practically no limits of steering angle
/// and rate.
VehicleParams Steered(const PlantSetup& setup);

/// Converts the initial state of a run to the state of the car's rear axle.
KinematicState InPlane(const StartState& start);

/// A plant that wraps a planar car model (such as KinematicCar or SingleTrackCar) that follows its
/// commands exactly. The wheels rotate as if they rolled without slip; this rotation is used only
/// for films.
template <typename Car>
class ExactPlant final : public Plant {
 public:
  ExactPlant(const CarModel& model, const Car& car)
      : model_(model), car_(car), state_(car.FullState()) {}

  void Step(const Command& command) override {
    const double timestep = model_.timestep();
    const VehicleState before = state_;
    car_.Step(command, timestep);
    state_ = car_.FullState();
    const WheelSpeeds speeds = RollingSpeeds(model_.params(), 0.5 * (before.speed + state_.speed),
                                             0.5 * (before.steering + state_.steering));
    spin_.resize(static_cast<std::size_t>(speeds.size()));
    for (std::size_t w = 0; w < spin_.size(); ++w) {
      spin_[w] += speeds[static_cast<Eigen::Index>(w)] / model_.params().wheel_radius * timestep;
    }
  }

  void ApplyLateralOffset(double left) override {
    car_.ApplyLateralOffset(left);
    state_ = car_.FullState();
  }

  void ApplyLateralForce(double force) override {
    TRACKBED_REQUIRE(std::isfinite(force), "ApplyLateralForce: {} N; must be finite", force);
    if constexpr (requires { car_.ApplyLateralForce(force); }) {
      car_.ApplyLateralForce(force * model_.timestep());
      state_ = car_.FullState();
    }
  }

  [[nodiscard]] VehicleState Observe() const override { return state_; }

  [[nodiscard]] std::optional<TrailerState> trailer() const override {
    if constexpr (requires { car_.trailer(); }) {
      return car_.trailer();
    } else {
      return std::nullopt;
    }
  }

  [[nodiscard]] Pose2 pose() const override { return state_.pose; }

  [[nodiscard]] std::vector<double> Configuration() const override {
    const std::optional<TrailerState> towed = trailer();
    return model_.FlatConfiguration(state_.pose, state_.steering, spin_,
                                    towed ? towed->angle : 0.0);
  }

  /// Whether a coordinate of the car exceeds the limit at which MuJoCo also reports divergence. An
  /// unstable car model spins ever faster until a coordinate of the car exceeds this limit.
  [[nodiscard]] bool diverged() const override {
    constexpr double kMaxCoordinate = 1e10;
    const Pose2& pose = car_.state().pose;
    return !(std::abs(pose.x) < kMaxCoordinate && std::abs(pose.y) < kMaxCoordinate &&
             std::abs(pose.yaw) < kMaxCoordinate);
  }

  [[nodiscard]] std::string divergence() const override {
    return diverged() ? "the car's motion is unstable: its position or yaw is beyond 1e10" : "";
  }

  [[nodiscard]] std::unique_ptr<Plant> Clone() const override {
    return std::make_unique<ExactPlant>(*this);
  }

 private:
  const CarModel& model_;
  Car car_;
  VehicleState state_;  // state of the car after the last simulated step
  std::vector<double> spin_;
};

}  // namespace trackbed
