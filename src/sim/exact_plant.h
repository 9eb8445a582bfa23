#pragma once

#include <cmath>
#include <vector>

#include "trackbed/sim/plant.h"

namespace trackbed {

/// The car's parameters with its steering as the setup wants it: wheels whose angle is prescribed
/// are there at once.
VehicleParams Steered(const PlantSetup& setup);

/// The start of a run as a state of the rear axle.
KinematicState InPlane(const StartState& start);

/// A plant made of a car that moves in the plane and obeys exactly: KinematicCar, SingleTrackCar.
/// Its wheels turn as those of a car that does not slip; that is for the film.
template <typename Car>
class ExactPlant final : public Plant {
 public:
  ExactPlant(const CarModel& model, const Car& car) : model_(model), car_(car) {}

  void Step(const Command& command) override {
    const double timestep = model_.timestep();
    const VehicleState before = car_.FullState();
    car_.Step(command, timestep);
    const VehicleState after = car_.FullState();
    const auto speeds = RollingSpeeds(model_.params(), 0.5 * (before.speed + after.speed),
                                      0.5 * (before.steering + after.steering));
    spin_.resize(speeds.size());
    for (std::size_t w = 0; w < speeds.size(); ++w) {
      spin_[w] += speeds[w] / model_.params().wheel_radius * timestep;
    }
  }

  void ApplyLateralOffset(double left) override { car_.ApplyLateralOffset(left); }

  void ApplyLateralForce(double force) override {
    if constexpr (requires { car_.ApplyLateralForce(force); }) {
      car_.ApplyLateralForce(force * model_.timestep());
    }
  }

  [[nodiscard]] VehicleState Observe() const override { return car_.FullState(); }

  [[nodiscard]] Pose2 pose() const override { return car_.FullState().pose; }

  [[nodiscard]] std::vector<double> Configuration() const override {
    const VehicleState state = car_.FullState();
    return model_.FlatConfiguration(state.pose, state.steering, spin_);
  }

  /// An unstable car spins ever faster. The limit is that of MuJoCo's numbers.
  [[nodiscard]] bool diverged() const override {
    constexpr double kLargest = 1e10;
    const Pose2& pose = car_.state().pose;
    return !(std::abs(pose.x) < kLargest && std::abs(pose.y) < kLargest &&
             std::abs(pose.yaw) < kLargest);
  }

 private:
  const CarModel& model_;
  Car car_;
  std::vector<double> spin_;
};

}  // namespace trackbed
