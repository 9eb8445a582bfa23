#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/driver_aids.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_response.h"
#include "trackbed/world/world.h"

/// Defines the interface of plants (simulated vehicles) and the registry of plants.
namespace trackbed {

/// A simulated vehicle, advanced one physics step at a time. The built-in plants throw
/// PreconditionError if a command, displacement or force is not finite; the state of the plant is
/// then unchanged.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances the simulation by one timestep of the model.
  virtual void Step(const Command& command) = 0;

  /// Displaces the car instantaneously by `left` [m] to its left, and puts the car on the ground at
  /// the new position. ApplyLateralOffset does not change the velocities of the car.
  virtual void ApplyLateralOffset(double left) = 0;

  /// Applies a horizontal force to the left [N] at the car's center of gravity during the next
  /// step. In plants that do not simulate forces, ApplyLateralForce has no effect.
  virtual void ApplyLateralForce(double force) = 0;

  /// Returns the present state of the vehicle. In plants that simulate forces, the returned
  /// accelerations and wheel forces are those of the last step.
  [[nodiscard]] virtual VehicleState Observe() const = 0;

  /// Returns the states of the driver aids; nullopt for a car without driver aids, as by default.
  [[nodiscard]] virtual std::optional<AidState> aids() const { return std::nullopt; }

  /// Returns the state of the trailer; nullopt for a car without a trailer, as by default.
  [[nodiscard]] virtual std::optional<TrailerState> trailer() const { return std::nullopt; }

  /// pose() and obstacle_force() return single members of Observe(), fast enough for a call in
  /// every physics step.
  [[nodiscard]] virtual Pose2 pose() const = 0;
  [[nodiscard]] virtual double obstacle_force() const { return 0.0; }

  /// Returns the present configuration vector of the vehicle (free joint and other joints).
  /// CarModel::configuration_columns returns the names of the configuration's components.
  [[nodiscard]] virtual std::vector<double> Configuration() const = 0;

  /// Whether the simulation has diverged. Do not call Step of a diverged plant.
  [[nodiscard]] virtual bool diverged() const = 0;

  /// Returns the reason why the simulation has diverged; empty if unknown.
  [[nodiscard]] virtual std::string divergence() const { return ""; }

  /// Returns the smallest distance between an undeformed tyre and the road below it [m]. The
  /// distance from the undeformed tyre to the road is negative while the load deflects the tyre.
  /// Plants whose wheels cannot leave the road return 0.
  [[nodiscard]] virtual double wheel_gap() const { return 0.0; }

  /// Returns an independent copy of the plant in its present state: for the same commands, both
  /// plants then simulate the same motion, bit for bit. The copy of the plant refers to the same
  /// car and world. Returns nullptr if the plant cannot be copied, as by default; all built-in
  /// plants can be copied. Throws RunError if there is not enough memory.
  [[nodiscard]] virtual std::unique_ptr<Plant> Clone() const { return nullptr; }
};

/// The arguments from which a plant is made. PlantSetup holds references to the car and the world,
/// both of which must outlive the plant.
struct PlantSetup {
  const CarModel& car;
  const World& world;
  StartState start;
  TyreLaw tyre = TyreLaw::kAuto;
  SteeringInput steering = SteeringInput::kActuator;
  AidOptions aids{};  ///< Driver aids, which only the MuJoCo plant simulates.
  /// State of the car's steering response after earlier commands. The steering filter must have the
  /// same timestep as the car's model. If `filter` is nullopt, the steering response starts in its
  /// steady state at the initial wheel angle.
  std::optional<SteeringFilter> filter{};
};

/// Returns the tyre law that the option `tyre` selects for a car: kAuto is replaced by the law that
/// suits the car, and other laws are returned unchanged.
TyreLaw SelectTyreLaw(const CarModel& car, TyreLaw tyre);

/// A plant in the registry of plants.
struct PlantEntry {
  const char* name;
  const char* summary;  ///< One-line description of the plant for users.
  std::function<std::unique_ptr<Plant>(const PlantSetup& setup)> make;
};

/// Name under which the recorded drive of a real vehicle appears among the plants of a run
/// (scenario/record.h). No plant in the registry may have the name kRecordedPlant.
inline constexpr const char* kRecordedPlant = "recorded";

/// Returns all plants, beginning with the built-in plants. The built-in plants are `kinematic`
/// (KinematicCar with the rear axle as reference point), `single_track` (SingleTrackCar) and
/// `mujoco` (the MJCF car, with the tyre law of the setup). The plants `mujoco:contact` and
/// `mujoco:magic_formula` use the tyre law in their name instead of the tyre law of the setup.
///
/// The plants `kinematic` and `single_track` follow the commanded acceleration exactly, and ignore
/// the obstacles, friction, grades and wind of the world. In `single_track`, a tyre has a constant
/// cornering stiffness, which does not depend on the road's friction. The plant `single_track`
/// requires a car with tyre coefficients; if coefficients are missing, making the plant throws
/// InputError with the car's file and the missing coefficients. An unstable car in the plant
/// `single_track` spins ever faster, and counts as diverged when a coordinate exceeds 1e10 m or
/// rad.
///
/// A run starts without slip unless the start state has a lateral speed or a yaw rate. The plant
/// `kinematic` ignores the lateral speed and the yaw rate of the start state. In the MuJoCo plant,
/// the springs start with the deflection of a car at rest.
///
/// The steering response of a car (VehicleParams::steering_response) applies to every plant,
/// including user-defined plants, because the plant receives the output of a SteeringFilter. If the
/// steering is prescribed (SteeringInput::kPrescribed), the steering response is not used.
///
/// ApplyLateralForce has no effect on `kinematic`, or on `single_track` at rest.
///
/// The MuJoCo plant converts a commanded acceleration in the direction of the gear to a drive
/// torque on the differential. The MuJoCo plant converts a commanded deceleration to dry friction
/// of the brakes. The braking torque is distributed between the front and rear wheels in proportion
/// to their largest brake torques in the model. Drive and brake torques are clamped to the model's
/// limits. Drive and brake torques are computed from the car's mass without payload. The angle of
/// the steering actuator is updated in every physics step, and changes at most at the model's rate
/// limit.
///
/// Driver aids (PlantSetup::aids) act in the MuJoCo plant on Magic Formula tyres. The plants
/// `kinematic` and `single_track` ignore driver aids, because their wheels neither lock nor spin.
/// MakePlant throws InputError for driver aids of a car on contact tyres, and of a vehicle with
/// differential drive.
///
/// A trailer (CarModel::trailer) is simulated by the plants `kinematic` and `mujoco`. In
/// `kinematic`, the wheels of the trailer do not slip, and the trailer has no effect on the car. In
/// MuJoCo, the trailer moves on a ball hitch, without brakes; its tyres follow the tyre law of the
/// car. MakePlant throws InputError for a trailer in `single_track`.
///
/// A vehicle with differential drive can only be simulated by the plants `kinematic` and `mujoco`,
/// the latter with the tyre law kContact. For a vehicle with differential drive, MakePlant throws
/// InputError if another plant is requested, or if prescribed steering is requested in MuJoCo. For
/// a vehicle with differential drive, the MuJoCo plant integrates the commanded acceleration to a
/// speed command, and a torque-limited servo controls the speed of each wheel. The measured
/// steering angle of a differential drive is atan((v_R - v_L)/v), where v_L and v_R are the speeds
/// of the wheels and v is their mean. At speeds v below 0.1 m/s, the measured steering angle of a
/// differential drive blends into the actuator's angle. The difference between the tangents of the
/// measured angle and the actuator's angle is weighted by (v/0.1 m/s)^2, with the speed v.
const std::vector<PlantEntry>& Plants();

/// Adds a plant to the registry, so that scenarios, `trackbed list`, messages and reports can use
/// its name. Call RegisterPlant at the start of main, because RegisterPlant is not thread-safe and
/// invalidates references to registry entries. Throws PreconditionError if the plant's name is
/// already in use or is kRecordedPlant.
void RegisterPlant(PlantEntry entry);

/// Makes the plant with the given name. If the registry has no plant of this name, throws
/// InputError, which suggests the most similar name. Throws PreconditionError if the start state is
/// not finite.
std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup);

}  // namespace trackbed
