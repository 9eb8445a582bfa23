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

/// The interface of plants (simulated vehicles), and the registry of plants.
namespace trackbed {

/// A simulated vehicle, advanced one physics step at a time. The built-in plants throw
/// PreconditionError for commands, displacements and forces that are not finite; the plant is then
/// unchanged.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances the simulation by one timestep of the model.
  virtual void Step(const Command& command) = 0;

  /// Displaces the car instantaneously by `left` [m] to its left, and puts it on the ground at the
  /// new position. The velocities of the car are unchanged.
  virtual void ApplyLateralOffset(double left) = 0;

  /// Applies a horizontal force to the left [N] at the center of gravity during the next step. In
  /// plants that do not simulate forces, ApplyLateralForce has no effect.
  virtual void ApplyLateralForce(double force) = 0;

  /// Returns the present state of the vehicle. In plants that simulate forces, the accelerations
  /// and wheel forces are those of the last step.
  [[nodiscard]] virtual VehicleState Observe() const = 0;

  /// Pose and obstacle force of Observe(), which are cheap enough for every physics step.
  [[nodiscard]] virtual Pose2 pose() const = 0;
  [[nodiscard]] virtual double obstacle_force() const { return 0.0; }

  /// Returns the present configuration. CarModel::configuration_columns has the names of the
  /// values.
  [[nodiscard]] virtual std::vector<double> Configuration() const = 0;

  /// Whether the simulation has diverged. A diverged plant must not be stepped.
  [[nodiscard]] virtual bool diverged() const = 0;

  /// Returns the reason for the divergence of the simulation; empty if unknown.
  [[nodiscard]] virtual std::string divergence() const { return ""; }

  /// Returns the smallest distance between an undeformed tyre and the road below it [m]. The
  /// distance is negative while a tyre is deflected by its load. Plants that cannot leave the road
  /// return 0.
  [[nodiscard]] virtual double wheel_gap() const { return 0.0; }
};

/// The arguments for making a plant. PlantSetup keeps references to the car and the world, which
/// must outlive the plant.
struct PlantSetup {
  const CarModel& car;
  const World& world;
  StartState start;
  TyreLaw tyre = TyreLaw::kAuto;
  SteeringInput steering = SteeringInput::kActuator;
  /// State of the car's steering response after earlier commands; its timestep must be that of the
  /// car. Nullopt: the steady state at the initial wheel angle.
  std::optional<SteeringFilter> filter{};
};

/// Returns the tyre law that `tyre` means for a car: replaces kAuto, and returns other laws
/// unchanged.
TyreLaw SelectTyreLaw(const CarModel& car, TyreLaw tyre);

/// An entry of the plant registry.
struct PlantEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  std::unique_ptr<Plant> (*make)(const PlantSetup& setup);
};

/// Name under which the record of a real vehicle appears among the plants of a run
/// (scenario/record.h). No plant in the registry may have this name.
inline constexpr const char* kRecordedPlant = "recorded";

/// Returns all plants, beginning with the built-in plants: `kinematic` (KinematicCar with the rear
/// axle as reference point), `single_track` (SingleTrackCar) and `mujoco` (the MJCF car, with the
/// tyre law of the setup). The plants `mujoco:contact` and `mujoco:magic_formula` use the named
/// tyre law instead of that of the setup.
///
/// The plants `kinematic` and `single_track` follow the commanded acceleration exactly and ignore
/// the world: obstacles, friction, grades and wind. In `single_track`, a tyre has a constant
/// cornering stiffness, which does not depend on the road's friction. `single_track` needs a car
/// with tyre coefficients; otherwise InputError names the car's file and the missing coefficients.
/// An unstable car on `single_track` spins ever faster; it counts as diverged when a coordinate
/// exceeds 1e10 m or rad.
///
/// A run starts without slip, unless the start state has a lateral speed or a yaw rate, which
/// `kinematic` ignores. In MuJoCo, the springs start with the deflection of a car at rest.
///
/// The steering response of a car (VehicleParams::steering_response) applies to every plant,
/// including user-defined plants, because the plant receives the output of a SteeringFilter.
/// Prescribed steering bypasses the steering response.
///
/// ApplyLateralForce has no effect on `kinematic`, or on `single_track` at rest.
///
/// The MuJoCo plant converts a commanded acceleration in the direction of the gear to a drive
/// torque on the differential. A deceleration becomes dry friction of the brakes. The braking
/// torque is distributed between front and rear in proportion to the model's brake torques. Drive
/// and brake torques are clamped to the model's limits. The conversion uses the car's mass without
/// payload. The angle of the steering actuator changes at every physics step, at most at the
/// model's rate limit.
///
/// A vehicle with differential drive can only run on `kinematic`, and on `mujoco` with the tyre law
/// kContact. MakePlant throws InputError for other plants, and for prescribed steering in MuJoCo.
/// For differential drive, the MuJoCo plant integrates the commanded acceleration to a speed
/// command, and a torque-limited servo controls the speed of each wheel. The measured steering
/// angle is atan((v_R - v_L)/v), where v_L and v_R are the speeds of the wheels and v is their
/// mean. Below 0.1 m/s, the measured angle blends into the actuator's angle: the difference of
/// their tangents is weighted by (v/0.1 m/s)^2.
const std::vector<PlantEntry>& Plants();

/// Adds a plant to the registry, so that scenarios, `trackbed list`, messages and reports can use
/// its name. Call RegisterPlant at the start of main, because it invalidates references to entries
/// and is not thread-safe. Throws PreconditionError if the name is already in use or is
/// kRecordedPlant.
void RegisterPlant(PlantEntry entry);

/// Makes the named plant. Throws InputError, which suggests the most similar name, if there is no
/// such plant. Throws PreconditionError if the start state is not finite.
std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup);

/// Makes a kinematic plant with the given reference point. With kCenterOfGravity, `start.speed` and
/// the commanded acceleration refer to the center of gravity.
std::unique_ptr<Plant> MakeKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

}  // namespace trackbed
