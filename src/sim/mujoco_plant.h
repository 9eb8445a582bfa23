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

/// A MuJoCo simulation: its data and its own copy of the model, because brakes and road modify the
/// model during a run. A copy of the object is an independent simulation in the same state.
class MujocoSimulation {
 protected:
  explicit MujocoSimulation(const mjModel& model)
      : model_(CopyMujocoModel(model)), data_(MakeMujocoData(*model_)) {}
  MujocoSimulation(const MujocoSimulation& other)
      : model_(CopyMujocoModel(*other.model_)), data_(CopyMujocoData(*model_, *other.data_)) {}
  MujocoSimulation& operator=(const MujocoSimulation&) = delete;
  ~MujocoSimulation() = default;

  MujocoModel model_;
  MujocoData data_;
};

/// Base class of the MuJoCo plants; handles the vehicle's state, the road, the air and external
/// forces. Derived classes implement the actuators and the wheels.
class MujocoPlant : public Plant, private MujocoSimulation {
 public:
  void Step(const Command& command) final;
  void ApplyLateralOffset(double left) final;
  void ApplyLateralForce(double force) final;
  [[nodiscard]] VehicleState Observe() const final;
  [[nodiscard]] std::optional<TrailerState> trailer() const final;
  [[nodiscard]] Pose2 pose() const final;
  [[nodiscard]] double obstacle_force() const final;
  [[nodiscard]] std::vector<double> Configuration() const final;
  [[nodiscard]] bool diverged() const final;
  [[nodiscard]] std::string divergence() const final;
  [[nodiscard]] double wheel_gap() const final;
  /// Returns the number of rows of the last step's constraints: contacts, joint limits, dry
  /// friction and couplings.
  [[nodiscard]] int constraint_rows() const { return data_->nefc; }

 protected:
  /// Friction factor of the road under each wheel, in the order of CarModel::wheels().
  using Road = std::array<double, 4>;
  /// Steering and wheel states of the car, as observed by the derived class.
  struct Wheels {
    double actuator = 0.0;  ///< Angle of the steering actuator, for
                            ///< VehicleState::steering_actuator.
    double steering = 0.0;  ///< Steering angle at the wheels, for VehicleState::steering.
    std::optional<std::array<WheelState, 4>> forces;
  };

  /// Motion of the car along the ground, equal to the members of VehicleState.
  struct PlanarMotion {
    double speed = 0.0;     ///< [m/s]
    double yaw_rate = 0.0;  ///< [rad/s]
    double sideslip = 0.0;  ///< [rad]
  };

  /// Initializes the car's position and velocity from `setup.start`, but not the spin of the
  /// wheels.
  explicit MujocoPlant(const PlantSetup& setup, TyreSupport support = TyreSupport::kContacts);
  /// Sets the speeds of the wheels' spin joints to those of wheels that roll without slip.
  /// `spin_dof` contains the degrees of freedom of the spin joints, in the order of
  /// CarModel::wheels().
  void RollWheels(std::span<const int> spin_dof, const StartState& start);
  /// Begin() must be called after the wheel spin and the actuators are set, and before the first
  /// step.
  void Begin();

  /// Sets the vehicle's actuators and brakes for the coming step; called before mj_step1.
  virtual void Act(const Command& command) = 0;
  /// Adds the wheel forces of a step to qfrc_applied; called between mj_step1 and mj_step2.
  virtual void ApplyWheelForces(const Road& /*road*/) {}
  /// Ends a simulation step of the derived plant; called after mj_step2.
  virtual void Finish(const Command& /*command*/) {}
  [[nodiscard]] virtual Wheels ObserveWheels() const = 0;

  [[nodiscard]] const CarModel& car() const { return car_; }
  [[nodiscard]] mjModel& model() { return *model_; }
  [[nodiscard]] const mjModel& model() const { return *model_; }
  [[nodiscard]] mjData& data() { return *data_; }
  [[nodiscard]] const mjData& data() const { return *data_; }
  /// Returns the friction factor of the road under the trailer's wheels in the present step.
  [[nodiscard]] const std::array<double, 2>& trailer_road() const { return trailer_road_; }
  /// Returns the car's forward speed over the ground [m/s].
  [[nodiscard]] double Speed() const;
  /// Returns the motion of the car along the ground.
  [[nodiscard]] PlanarMotion Motion() const;
  /// Returns the aerodynamic drag of the car [N], which is positive if it opposes forward motion.
  [[nodiscard]] double Drag() const;

 private:
  /// Indices in qpos and qvel of a joint whose motion is prescribed.
  struct MovedJoint {
    int qpos = -1;
    int dof = -1;
  };

  /// The joints of the model along which an obstacle of the world moves.
  struct Mover {
    std::size_t obstacle = 0;
    MovedJoint x;
    MovedJoint y;
    std::optional<MovedJoint> yaw;
  };

  void StartTrailer(const StartState& start);
  void MoveObstacles();
  [[nodiscard]] const mjtNum* ChassisPosition() const;
  [[nodiscard]] const mjtNum* ChassisVelocity() const;
  [[nodiscard]] Eigen::Matrix3d ChassisRotation() const;
  [[nodiscard]] double Yaw() const;
  [[nodiscard]] Vec2 Ahead() const;
  [[nodiscard]] Road UpdateRoadFriction();
  [[nodiscard]] Eigen::Vector3d AirSpeed() const;
  void ApplyAirForce();
  void ApplyPendingLateralForce();

  const CarModel& car_;
  const World& world_;
  RoadContact ground_;
  std::vector<Mover> movers_;
  std::vector<bool> is_obstacle_;  // For each geom of the model, whether it is an obstacle.
  // For each geom of the model, whether it belongs to the car.
  std::vector<bool> is_of_car_;
  std::array<double, 4> tyre_friction_{};  // Friction coefficient of each tyre contact on a road
                                           // with friction factor 1.
  double trailer_friction_ = 0.0;          // Friction coefficient of the trailer's tyre contacts.
  std::array<double, 2> trailer_road_{};
  double yaw_ = 0.0;       // Heading, unwrapped [rad].
  double distance_ = 0.0;  // Driven distance [m].
  // Lateral push on the car in the coming step, positive to the left [N].
  double pending_lateral_force_ = 0.0;
};

}  // namespace trackbed
