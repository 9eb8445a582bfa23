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

/// A simulated vehicle, advanced one physics step at a time. Those of Trackbed refuse commands,
/// displacements and forces that are not finite, and are as they were: PreconditionError.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances by one timestep of the model.
  virtual void Step(const Command& command) = 0;

  /// Displaces the car instantaneously by `left` [m] to its left, keeping its motion, onto the
  /// ground there.
  virtual void ApplyLateralOffset(double left) = 0;

  /// Applies a horizontal force to the left [N] at the center of gravity during the next step. No
  /// effect on plants without forces.
  virtual void ApplyLateralForce(double force) = 0;

  /// The state now. For plants with forces, accelerations and wheel forces are those of the step
  /// that led here.
  [[nodiscard]] virtual VehicleState Observe() const = 0;

  /// Two values of Observe(), for use at every physics step.
  [[nodiscard]] virtual Pose2 pose() const = 0;
  [[nodiscard]] virtual double obstacle_force() const { return 0.0; }

  /// The configuration now, as CarModel::configuration_columns names it.
  [[nodiscard]] virtual std::vector<double> Configuration() const = 0;

  /// Whether the simulation has diverged; such a plant must not be stepped.
  [[nodiscard]] virtual bool diverged() const = 0;

  /// What made it diverge, for people; empty where that is not known.
  [[nodiscard]] virtual std::string divergence() const { return ""; }

  /// Height of the lowest wheel's lowest point over the road under it [m], of a tyre that is not
  /// deformed: minus its deflection while it carries the car. 0 for plants that cannot leave the
  /// road.
  [[nodiscard]] virtual double wheel_gap() const { return 0.0; }
};

/// The arguments for making a plant. Holds references to car and world, which must outlive the
/// plant.
struct PlantSetup {
  const CarModel& car;
  const World& world;
  StartState start;
  TyreLaw tyre = TyreLaw::kAuto;
  SteeringInput steering = SteeringInput::kActuator;
  /// The car's steering response as earlier commands have left it, made for the car's timestep.
  /// None: as if what keeps the wheels where they start had always been commanded.
  std::optional<SteeringFilter> filter{};
};

/// Resolves `tyre` for a car: never kAuto.
TyreLaw SelectTyreLaw(const CarModel& car, TyreLaw tyre);

/// A plant in the registry.
struct PlantEntry {
  const char* name;
  const char* summary;  ///< one line, for users
  std::unique_ptr<Plant> (*make)(const PlantSetup& setup);
};

/// What the record of a real vehicle is called among the plants of a run (scenario/record.h). No
/// plant of the registry may have this name.
inline constexpr const char* kRecordedPlant = "recorded";

/// All plants, those of Trackbed first: `kinematic` (KinematicCar, rear-axle reference),
/// `single_track` (SingleTrackCar) and `mujoco` (the MJCF car on its contacts, with the tyre law of
/// the setup); `mujoco:contact` and `mujoco:magic_formula` have their own law whatever the setup's
/// is.
///
/// The first two follow the commanded acceleration exactly and ignore the world: obstacles,
/// friction, grades and wind. (A linear tyre has only a stiffness, which does not depend on the
/// road's friction.) `single_track` needs a car with tyre coefficients, else InputError names its
/// file and what is missing there. Where it is unstable it ends as diverged, 1e10 m or rad away.
///
/// Plants begin without slip, unless the start has a lateral speed or a yaw rate, which `kinematic`
/// ignores; those of MuJoCo stand on their springs as at rest.
///
/// A car with a steering response (VehicleParams::steering_response) has it on every plant,
/// registered ones included: what the plant is commanded is what the SteeringFilter gives. Not with
/// prescribed steering.
///
/// ApplyLateralForce has no effect on `kinematic`, nor on `single_track` at rest.
///
/// The MuJoCo plant converts a commanded acceleration to drive torque on its differential, or,
/// against the gear, into dry friction of the brakes, front to rear as the model's brake torques;
/// both are cut at the model's limits. It uses the car's unladen mass. Its steering actuator's rate
/// limit is the model's own, updated at every physics step.
///
/// With differential drive there are `kinematic` and `mujoco` with the tyre law kContact; for the
/// others, for prescribed steering in MuJoCo, InputError. There MuJoCo integrates the commanded
/// acceleration to a speed command, and torque-limited servos control each wheel's speed. The
/// measured steering angle is atan((v_R - v_L)/v) of the wheels' speeds; below 0.1 m/s its
/// difference from the actuator's angle is weighted by (v/0.1 m/s)^2, so that at rest it is the
/// actuator's angle.
const std::vector<PlantEntry>& Plants();

/// Adds a plant to the registry, for scenarios, `trackbed list`, messages and reports. Call it at
/// the start of main: it invalidates references to entries and is not thread-safe.
/// PreconditionError when the name is taken, or kRecordedPlant.
void RegisterPlant(PlantEntry entry);

/// InputError with the nearest spelling when there is no such plant, PreconditionError for a start
/// that is not finite.
std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup);

/// The kinematic plant with the reference point of your choice: with kCenterOfGravity,
/// `start.speed` and the commanded acceleration are those of the center of gravity.
std::unique_ptr<Plant> MakeKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

}  // namespace trackbed
