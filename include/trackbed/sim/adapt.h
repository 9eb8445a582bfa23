#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/vehicle/params.h"

/// Proposes a car file (docs/models.md) for a vehicle model that was written for another program.
namespace trackbed {

/// Options of the adaptation, with answers to questions that the vehicle's geometry leaves open.
/// The options of `trackbed model --adapt` have the names of the members of AdaptOptions.
struct AdaptOptions {
  /// Folders for meshes (SceneOptions::asset_folders).
  std::vector<std::filesystem::path> asset_folders{};
  /// Name of the body that is or contains the vehicle, for a file with several vehicles.
  std::string body{};
  std::optional<double> wheel_radius{};  ///< Radius of all wheels [m].
  /// Largest steering angle of the bicycle model to each side [rad].
  std::optional<double> steering_limit{};
  std::optional<double> steering_rate{};  ///< Largest steering rate of the bicycle model [rad/s].
  std::optional<double> drive_torque{};   ///< Largest torque on all driven wheels together [N m].
  /// Whether only the front axle steers, although the rear wheels of the model have steering
  /// joints, too. The rear wheels of the proposed car point straight ahead.
  bool steers_front_only = false;
};

/// One decision of AdaptModel about the proposed car.
struct AdaptGuess {
  std::string what;   ///< Part or parameter of the car, such as "wheel fl" or "steering limit".
  std::string value;  ///< The proposed value, with its unit.
  /// The parts of the model from which the proposed value follows. The evidence begins with
  /// "assumed" if nothing in the model determines the value.
  std::string evidence;
};

/// A car file that AdaptModel proposes.
struct AdaptedModel {
  VehicleKind kind = VehicleKind::kSteered;
  std::string xml;                  ///< MJCF text of the car file, without references to files.
  std::vector<AdaptGuess> guesses;  ///< Decisions of AdaptModel, by part of the car.
  /// Faults of the given model that would disturb a run, such as tyres that touch the chassis. The
  /// proposed file does not contain the faults of the given model.
  std::vector<std::string> notes;
};

/// Reads a vehicle from an MJCF file or a URDF file, finds its parts by their geometry, and writes
/// a new car file with these parts. Joints and bodies may have any names; AdaptGuess::evidence
/// states the names.
///
/// A wheel is a body on a hinge joint with a nearly horizontal axis. A geom of the wheel's body is
/// round about the hinge axis and touches the ground. A steered wheel also turns about a nearly
/// vertical hinge; the steered axle is the front axle. A vehicle with four wheels is a car, and one
/// axle of a car must steer. A vehicle with two driven wheels that do not steer has differential
/// drive, and is supported by casters or skids of the model. The proposed file has the total mass,
/// center of gravity and inertia of the model at its initial configuration qpos0. Joints other than
/// those of wheels, steering and suspension are locked.
///
/// MuJoCo reads URDF files. The meshes of a URDF file must be .stl or .obj files in the folder of
/// the file, in the ROS package that contains the file, or in AdaptOptions::asset_folders. Meshes
/// of other types or in other folders are dropped; a note lists the dropped meshes.
///
/// Errors: throws InputError if the file cannot be read or does not compile. Throws InputError,
/// with a question and the option that answers it, if the model has no vehicle with four wheels or
/// with two driven wheels. Also throws InputError if the steered axle cannot be determined, or if
/// nothing in the model suggests a value for a missing limit. The limits of ComposeScene and
/// CompileScene apply to the model's size and to the separate process that compiles the model.
/// AdaptModel compiles the model twice.
AdaptedModel AdaptModel(const std::filesystem::path& file, const AdaptOptions& options);

}  // namespace trackbed
