#include <numbers>

#include "src/sim/plants.h"

namespace trackbed {
namespace {

class KinematicPlant final : public Plant {
 public:
  KinematicPlant(const PlantSetup& setup, ReferencePoint reference)
      : model_(setup.car),
        car_(Steered(setup), reference, StateAt(setup.car.params(), setup.start, reference)) {}

  void Step(const Command& command) override {
    const double timestep = model_.timestep();
    const VehicleState before = car_.FullState();
    car_.Step(command, timestep);
    const VehicleState after = car_.FullState();
    const auto speeds = RollingSpeeds(model_.params(), 0.5 * (before.speed + after.speed),
                                      0.5 * (before.steering + after.steering));
    for (std::size_t w = 0; w < spin_.size(); ++w) {
      spin_[w] += speeds[w] / model_.params().wheel_radius * timestep;
    }
  }

  [[nodiscard]] VehicleState Observe() const override { return car_.FullState(); }

  [[nodiscard]] std::vector<double> Configuration() const override {
    const VehicleState state = car_.FullState();
    return model_.FlatConfiguration(state.pose, state.steering, spin_);
  }

  [[nodiscard]] bool diverged() const override { return false; }

 private:
  /// Wheels whose angle is prescribed are there at once.
  static VehicleParams Steered(const PlantSetup& setup) {
    VehicleParams params = setup.car.params();
    if (setup.steering == SteeringInput::kPrescribed) {
      params.steering_rate = 1e9;
      params.steering_limit = 0.5 * std::numbers::pi;
    }
    return params;
  }

  static KinematicState StateAt(const VehicleParams& params, const StartState& start,
                                ReferencePoint reference) {
    KinematicState state{.pose = start.pose, .speed = start.speed, .steering = start.steering};
    if (reference == ReferencePoint::kCentreOfGravity) {
      const Vec2 cg = ToWorld(start.pose, {params.cg_to_rear, 0.0});
      state.pose.x = cg.x();
      state.pose.y = cg.y();
    }
    return state;
  }

  const CarModel& model_;
  KinematicCar car_;
  std::array<double, 4> spin_{};
};

}  // namespace

std::unique_ptr<Plant> MakeKinematicPlant(const PlantSetup& setup, ReferencePoint reference) {
  return std::make_unique<KinematicPlant>(setup, reference);
}

}  // namespace trackbed
