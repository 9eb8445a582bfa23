#include "src/sim/steering_filter_plant.h"

#include <cmath>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/vehicle/steering_response.h"

namespace trackbed {
namespace {

class SteeringFilterPlant final : public Plant {
 public:
  SteeringFilterPlant(std::unique_ptr<Plant> plant, SteeringFilter filter)
      : plant_(std::move(plant)), filter_(std::move(filter)) {}

  void Step(const Command& command) override {
    TRACKBED_REQUIRE(std::isfinite(command.acceleration), "Step: acceleration {}; must be finite",
                     // the acceleration is checked before the state of the filter changes
                     command.acceleration);
    Command filtered = command;
    filtered.steering = filter_.Pass(command.steering);
    plant_->Step(filtered);
  }

  void ApplyLateralOffset(double left) override { plant_->ApplyLateralOffset(left); }
  void ApplyLateralForce(double force) override { plant_->ApplyLateralForce(force); }
  [[nodiscard]] VehicleState Observe() const override { return plant_->Observe(); }
  [[nodiscard]] std::optional<AidState> aids() const override { return plant_->aids(); }
  [[nodiscard]] std::optional<TrailerState> trailer() const override { return plant_->trailer(); }
  [[nodiscard]] Pose2 pose() const override { return plant_->pose(); }
  [[nodiscard]] double obstacle_force() const override { return plant_->obstacle_force(); }
  [[nodiscard]] std::vector<double> Configuration() const override {
    return plant_->Configuration();
  }
  [[nodiscard]] bool diverged() const override { return plant_->diverged(); }
  [[nodiscard]] std::string divergence() const override { return plant_->divergence(); }
  [[nodiscard]] double wheel_gap() const override { return plant_->wheel_gap(); }
  [[nodiscard]] std::unique_ptr<Plant> Clone() const override {
    std::unique_ptr<Plant> plant = plant_->Clone();
    return plant ? std::make_unique<SteeringFilterPlant>(std::move(plant), filter_) : nullptr;
  }

 private:
  std::unique_ptr<Plant> plant_;
  SteeringFilter filter_;
};

}  // namespace

std::unique_ptr<Plant> WithSteeringResponse(std::unique_ptr<Plant> plant, const PlantSetup& setup) {
  const SteeringResponse& response = setup.car.params().steering_response;
  if (response.ideal() || setup.steering == SteeringInput::kPrescribed) {
    return plant;
  }
  return std::make_unique<SteeringFilterPlant>(
      std::move(plant), setup.filter
                            ? *setup.filter
                            : SteeringFilter(response, setup.car.timestep(), setup.start.steering));
}

}  // namespace trackbed
