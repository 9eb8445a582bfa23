#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "src/sim/road_contact.h"
#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

/// What the plants of MuJoCo have in common, whatever moves the vehicle: its state, the road, the
/// air and what pushes it.
class MujocoPlant : public Plant {
 public:
  void Step(const Command& command) final;
  void ApplyLateralOffset(double left) final;
  void ApplyLateralForce(double force) final;
  [[nodiscard]] VehicleState Observe() const final;
  [[nodiscard]] Pose2 pose() const final;
  [[nodiscard]] double obstacle_force() const final;
  [[nodiscard]] std::vector<double> Configuration() const final;
  [[nodiscard]] bool diverged() const final;
  [[nodiscard]] std::string divergence() const final;
  [[nodiscard]] double wheel_gap() const final;
  /// Of the last step: contacts, joint limits, dry friction and couplings.
  [[nodiscard]] int constraint_rows() const { return data_->nefc; }

 protected:
  /// The factor of the road under each wheel; as many count as the vehicle has.
  using Road = std::array<double, 4>;
  /// What a vehicle says of its own wheels.
  struct Wheels {
    double actuator = 0.0;  ///< VehicleState::steering_actuator
    double steering = 0.0;  ///< likewise
    std::optional<std::array<WheelState, 4>> forces;
  };

  /// The vehicle stands and moves as `setup.start` says, but for its wheels' spin.
  explicit MujocoPlant(const PlantSetup& setup, TyreSupport support = TyreSupport::kContacts);
  /// Sets the speeds of the wheels' spin joints, in the order of CarModel::wheels(): they roll
  /// without slip.
  void RollWheels(std::span<const int> spin_dof, const StartState& start);
  /// To be called once spin and actuators are set as well.
  void Begin();

  /// Before a step: sets actuators and brakes.
  virtual void Act(const Command& command) = 0;
  /// In the middle of it: adds forces of the wheels to qfrc_applied.
  virtual void PushWheels(const Road& /*road*/) {}
  /// After it.
  virtual void Finish(const Command& /*command*/) {}
  [[nodiscard]] virtual Wheels ObserveWheels() const = 0;

  [[nodiscard]] const CarModel& car() const { return car_; }
  [[nodiscard]] mjModel& model() { return *model_; }
  [[nodiscard]] const mjModel& model() const { return *model_; }
  [[nodiscard]] mjData& data() { return *data_; }
  [[nodiscard]] const mjData& data() const { return *data_; }
  /// Along x, over the ground [m/s].
  [[nodiscard]] double Speed() const;
  /// Force of the air along x [N].
  [[nodiscard]] double Drag() const;

 private:
  /// A joint along which an obstacle moves.
  struct Slider {
    int qpos = -1;
    int dof = -1;
    double speed = 0.0;  // [m/s]
  };

  void MoveObstacles();
  [[nodiscard]] const mjtNum* ChassisPosition() const;
  [[nodiscard]] const mjtNum* ChassisVelocity() const;
  [[nodiscard]] Eigen::Matrix3d ChassisRotation() const;
  [[nodiscard]] double Yaw() const;
  [[nodiscard]] Vec2 Ahead() const;
  [[nodiscard]] Road LayRoad();
  [[nodiscard]] Eigen::Vector3d AirSpeed() const;
  void PushByAir();
  void PushAside();

  const CarModel& car_;
  const World& world_;
  MujocoModel model_;  // own copy: brakes and road change it
  MujocoData data_;
  RoadContact ground_;
  std::vector<Slider> sliders_;
  std::vector<bool> is_obstacle_;          // geom by geom
  std::vector<bool> is_of_car_;            // likewise
  std::array<double, 4> tyre_friction_{};  // of the contacts, on a road of factor 1
  double yaw_ = 0.0;                       // unwrapped [rad]
  double distance_ = 0.0;                  // [m]
  double push_ = 0.0;                      // to the left, in the coming step [N]
};

/// The MuJoCo plant of a car with steered front wheels, and of a vehicle with differential drive.
std::unique_ptr<Plant> MakeCarPlant(const PlantSetup& setup);
std::unique_ptr<Plant> MakeWheelPairPlant(const PlantSetup& setup);

}  // namespace trackbed
