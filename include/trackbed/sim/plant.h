#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_response.h"
#include "trackbed/world/world.h"

/// The interface of plants and their registry.
namespace trackbed {

/// A simulated vehicle, advanced one physics step at a time. The built-in plants throw
/// PreconditionError for commands, displacements and forces that are not finite, and then stay
/// unchanged.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances by one timestep of the model.
  virtual void Step(const Command& command) = 0;

  /// Displaces the car instantaneously by `left` [m] to its left, onto the ground there. The motion
  /// of the car is unchanged.
  virtual void ApplyLateralOffset(double left) = 0;

  /// Applies a horizontal force to the left [N] at the center of gravity during the next step. The
  /// force has no effect on plants without forces.
  virtual void ApplyLateralForce(double force) = 0;

  /// The present state. For plants with forces, accelerations and wheel forces are those of the
  /// last step.
  [[nodiscard]] virtual VehicleState Observe() const = 0;

  /// Two values of Observe(), for use at every physics step.
  [[nodiscard]] virtual Pose2 pose() const = 0;
  [[nodiscard]] virtual double obstacle_force() const { return 0.0; }

  /// The present configuration, with the names of CarModel::configuration_columns.
  [[nodiscard]] virtual std::vector<double> Configuration() const = 0;

  /// Whether the simulation has diverged. A diverged plant must not be stepped.
  [[nodiscard]] virtual bool diverged() const = 0;

  /// Why the simulation diverged; empty if unknown.
  [[nodiscard]] virtual std::string divergence() const { return ""; }

  /// Height of the lowest wheel's lowest point over the road under it [m], for an undeformed tyre.
  /// While the tyre carries the car, this is minus its deflection. 0 for plants that cannot leave
  /// the road.
  [[nodiscard]] virtual double wheel_gap() const { return 0.0; }
};

/// The arguments for making a plant. The setup holds references to car and world, which must
/// outlive the plant.
struct PlantSetup {
  const CarModel& car;
  const World& world;
  StartState start;
  TyreLaw tyre = TyreLaw::kAuto;
  SteeringInput steering = SteeringInput::kActuator;
  /// State of the car's steering response after earlier commands, made for the car's timestep.
  /// Nullopt: the state in which a constant command has held the initial wheel angle.
  std::optional<SteeringFilter> filter{};
};

/// Resolves `tyre` for a car; never returns kAuto.
TyreLaw SelectTyreLaw(const CarModel& car, TyreLaw tyre);

/// A plant in the registry.
struct PlantEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  std::unique_ptr<Plant> (*make)(const PlantSetup& setup);
};

/// The name of the record of a real vehicle among the plants of a run (scenario/record.h). No plant
/// of the registry may have this name.
inline constexpr const char* kRecordedPlant = "recorded";

/// All plants, the built-in ones first: `kinematic` (KinematicCar, rear-axle reference),
/// `single_track` (SingleTrackCar) and `mujoco` (the MJCF car on its contacts, with the tyre law of
/// the setup). The plants `mujoco:contact` and `mujoco:magic_formula` use the named tyre law
/// instead of the setup's.
///
/// The plants `kinematic` and `single_track` follow the commanded acceleration exactly and ignore
/// the world: obstacles, friction, grades and wind. A linear tyre only has a stiffness, which does
/// not depend on the road's friction. `single_track` needs a car with tyre coefficients; otherwise
/// InputError names the car's file and the missing coefficients. If `single_track` is unstable, it
/// diverges and ends at 1e10 m or rad.
///
/// Plants begin without slip, unless the start has a lateral speed or a yaw rate, which `kinematic`
/// ignores. MuJoCo's plants stand on their springs as at rest.
///
/// The steering response of a car (VehicleParams::steering_response) applies to every plant,
/// including user-defined plants: the plant receives the output of the SteeringFilter. Prescribed
/// steering bypasses the response.
///
/// ApplyLateralForce has no effect on `kinematic`, nor on `single_track` at rest.
///
/// The MuJoCo plant converts a commanded acceleration to drive torque on its differential, or,
/// against the gear, to dry friction of the brakes. The brakes are distributed between front and
/// rear like the model's brake torques. Both torques are clamped to the model's limits. The
/// conversion uses the car's unladen mass. The steering actuator has the rate limit of the model,
/// updated at every physics step.
///
/// With differential drive, only `kinematic` and `mujoco` with the tyre law kContact are available.
/// InputError for other plants, and for prescribed steering in MuJoCo. With differential drive,
/// MuJoCo integrates the commanded acceleration to a speed command, and torque-limited servos
/// control each wheel's speed. The measured steering angle is atan((v_R - v_L)/v) of the wheels'
/// speeds. Below 0.1 m/s, its difference from the actuator's angle is weighted by (v/0.1 m/s)^2, so
/// that at rest it equals the actuator's angle.
const std::vector<PlantEntry>& Plants();

/// Adds a plant to the registry, for scenarios, `trackbed list`, messages and reports. Call
/// RegisterPlant at the start of main: it invalidates references to entries and is not thread-safe.
/// PreconditionError if the name is taken, or is kRecordedPlant.
void RegisterPlant(PlantEntry entry);

/// Makes the named plant. InputError with the nearest spelling if there is no such plant.
/// PreconditionError for a start that is not finite.
std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup);

/// Makes a kinematic plant with the given reference point. With kCenterOfGravity, `start.speed` and
/// the commanded acceleration are those of the center of gravity.
std::unique_ptr<Plant> MakeKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

}  // namespace trackbed
