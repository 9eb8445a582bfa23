#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "trackbed/sim/car_model.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

/// The interface of everything that can be driven, and the registry of plants.
namespace trackbed {

/// Where and how a drive begins.
struct StartState {
  Pose2 pose;             ///< rear-axle center
  double speed = 0.0;     ///< [m/s]
  double steering = 0.0;  ///< bicycle angle, wheels and actuator alike [rad]
};

/// A car that obeys commands, one physics step at a time. The drive does not know which it holds.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances by one timestep of the model.
  virtual void Step(const Command& command) = 0;

  /// Sets the car aside by `left` [m], to its left, at once: as it stands and moves, on the ground
  /// that is there.
  virtual void ApplyLateralOffset(double left) = 0;

  /// A horizontal force to the left [N] that acts on its center of gravity during the next step
  /// alone. Cars that know no forces do not feel it.
  virtual void ApplyLateralForce(double force) = 0;

  /// The state now. For plants with forces, accelerations and wheel forces are those of the step
  /// that led here.
  [[nodiscard]] virtual VehicleState Observe() const = 0;

  /// Two numbers of Observe() alone, for what looks at every physics step.
  [[nodiscard]] virtual Pose2 pose() const = 0;
  [[nodiscard]] virtual double obstacle_force() const { return 0.0; }

  /// The configuration now, as CarModel::configuration_columns names it.
  [[nodiscard]] virtual std::vector<double> Configuration() const = 0;

  /// Whether the physics has left the numbers it can compute with; such a plant must not be
  /// stepped.
  [[nodiscard]] virtual bool diverged() const = 0;
};

/// What holds the wheels of the MuJoCo plant to the road.
enum class TyreLaw {
  kAuto,          ///< the Magic Formula for cars whose file has its coefficients, else contacts
  kContact,       ///< MuJoCo's friction cone: no slip to speed of below the friction limit
  kMagicFormula,  ///< forces grow with slip (vehicle/magic_formula.h); contacts carry the load
                  ///< alone
};

/// How the wanted steering angle reaches the road wheels.
enum class SteeringInput {
  kActuator,    ///< through the car's actuator, within its rate and angle
  kPrescribed,  ///< exactly and at once, for validation
};

/// What a plant is made of. It keeps references to car and world, which must outlive it.
struct PlantSetup {
  const CarModel& car;
  const World& world;
  StartState start;
  TyreLaw tyre = TyreLaw::kAuto;
  SteeringInput steering = SteeringInput::kActuator;
};

/// What `tyre` means for a car: never kAuto.
TyreLaw TyreLawOf(const CarModel& car, TyreLaw tyre);

/// A plant in the registry.
struct PlantEntry {
  const char* name;
  const char* summary;  ///< for people, on one line
  std::unique_ptr<Plant> (*make)(const PlantSetup& setup);
};

/// All plants, those of Trackbed first: `kinematic` (KinematicCar, rear-axle reference),
/// `single_track` (SingleTrackCar) and `mujoco` (the MJCF car on its contacts, with the tyre law of
/// the setup); `mujoco:contact` and `mujoco:magic_formula` have their own law whatever the setup's
/// is.
///
/// The first two obey the commanded acceleration exactly and know nothing of the world: no
/// obstacles, friction, grades or wind. (A road's friction is no part of a tyre's stiffness, which
/// is all that a linear tyre has.) `single_track` needs a car with tyre coefficients, else
/// InputError names its file and what is missing there; it begins without slip, as every plant
/// does. Where it is unstable it ends as diverged, 1e10 m or rad away.
///
/// `kinematic` feels no ApplyLateralForce, and `single_track` none at rest.
///
/// The MuJoCo plant turns a wanted acceleration into drive torque on its differential, or, against
/// the gear, into dry friction of the brakes, front to rear as the model's brake torques; both are
/// cut at the model's limits. It reckons with the car's unladen mass. Its steering actuator's rate
/// limit is the model's own, fed anew at every physics step.
///
/// With differential drive there are `kinematic` and `mujoco` with the tyre law kContact; for the
/// others, for prescribed steering in MuJoCo, InputError. There MuJoCo integrates the wanted
/// acceleration to a wanted speed, and servos of limited torque hold each wheel at its share. The
/// measured steering angle is atan((v_R - v_L)/v) of the wheels' speeds; below 0.1 m/s what they
/// are off counts with (v/0.1 m/s)^2 only, so that it is the actuator's at rest.
const std::vector<PlantEntry>& Plants();

/// Adds a plant to the registry, for scenarios, `trackbed list`, messages and reports. Call it at
/// the start of main: it invalidates references to entries and is not thread-safe.
/// PreconditionError when the name is taken.
void RegisterPlant(PlantEntry entry);

/// InputError with the nearest spelling when there is no such plant.
std::unique_ptr<Plant> MakePlant(const std::string& name, const PlantSetup& setup);

/// `name` as it stands in file names: "mujoco:contact" is "mujoco-contact".
std::string PlantFileName(const std::string& name);

/// The kinematic plant with the reference point of your choice: with kCenterOfGravity,
/// `start.speed` and the commanded acceleration are those of the center of gravity.
std::unique_ptr<Plant> MakeKinematicPlant(const PlantSetup& setup, ReferencePoint reference);

}  // namespace trackbed
