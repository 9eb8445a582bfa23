#include <trackbed/cli/main.h>
#include <trackbed/sim/plant.h>

using namespace trackbed;

/// The kinematic car with a slow power steering, which passes the commanded steering angle to the
/// car's actuator through a first-order filter with a time constant of 0.2 s.
class LaggingPlant final : public Plant {
 public:
  explicit LaggingPlant(const PlantSetup& setup)
      : car_(MakePlant("kinematic", setup)),
        step_(setup.car.timestep() / 0.2),
        steering_(setup.start.steering) {}

  void Step(const Command& command) override {
    steering_ += step_ * (command.steering - steering_);
    Command delayed = command;
    delayed.steering = steering_;
    car_->Step(delayed);
  }
  void ApplyLateralOffset(double left) override { car_->ApplyLateralOffset(left); }
  void ApplyLateralForce(double force) override { car_->ApplyLateralForce(force); }
  [[nodiscard]] VehicleState Observe() const override { return car_->Observe(); }
  [[nodiscard]] Pose2 pose() const override { return car_->pose(); }
  [[nodiscard]] std::vector<double> Configuration() const override { return car_->Configuration(); }
  [[nodiscard]] bool diverged() const override { return car_->diverged(); }

 private:
  std::unique_ptr<Plant> car_;
  double step_;      // Gain of the filter per step: timestep divided by time constant.
  double steering_;  // Filtered steering angle, the command to the car's actuator [rad].
};

int main(int argc, char** argv) {
  RegisterPlant({.name = "lagging",
                 .summary = "the kinematic car behind a slow power steering",
                 .make = [](const PlantSetup& setup) -> std::unique_ptr<Plant> {
                   return std::make_unique<LaggingPlant>(setup);
                 }});
  return Main(argc, argv);
}
