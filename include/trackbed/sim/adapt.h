#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/vehicle/params.h"

/// Proposes a car file (docs/models.md) for a vehicle model that was written for another program.
namespace trackbed {

/// Answers to questions that the geometry of a model leaves open. Options of `trackbed model
/// --adapt` have the same names.
struct AdaptOptions {
  std::vector<std::filesystem::path> asset_folders{};  ///< As SceneOptions::asset_folders.
  /// Name of the body that is the vehicle, or that contains it, if the file has several vehicles.
  std::string body{};
  std::optional<double> wheel_radius{};    ///< Radius of all wheels [m].
  std::optional<double> steering_limit{};  ///< Largest bicycle angle to each side [rad].
  std::optional<double> steering_rate{};   ///< Largest rate of the bicycle angle [rad/s].
  std::optional<double> drive_torque{};    ///< Largest torque on all driven wheels together [N m].
  /// Whether only the front axle steers, although the rear wheels of the model have steering
  /// joints, too. The rear wheels of the proposed car point straight ahead.
  bool steers_front_only = false;
};

/// One decision of AdaptModel.
struct AdaptGuess {
  std::string what;   ///< Part or parameter of the car, such as "wheel fl" or "steering limit".
  std::string value;  ///< The proposed value, with its unit.
  /// The parts of the model from which the value follows. Begins with "assumed" if nothing in the
  /// model determines the value.
  std::string evidence;
};

/// A car file that AdaptModel proposes.
struct AdaptedModel {
  VehicleKind kind = VehicleKind::kSteered;
  std::string xml;                  ///< MJCF text of the car file, without references to files.
  std::vector<AdaptGuess> guesses;  ///< In the order of the parts of the car.
  /// Properties of the given model that a run would have been wrong with, such as tyres that touch
  /// the chassis. The proposed file does not have them.
  std::vector<std::string> notes;
};

/// Reads a vehicle from an MJCF file or a URDF file, finds its parts by their geometry, and writes
/// a new car file with these parts. Names of joints and bodies appear only in the evidence.
///
/// Wheels are hinge joints with a nearly horizontal axis whose body carries a round geom around the
/// axis that touches the ground. Steered wheels turn about a nearly vertical hinge, too; the
/// steered axle is in front. Four wheels make a car, of which one axle must steer. Two driven
/// wheels that do not steer make a vehicle with differential drive; casters or skids of the model
/// support it. The proposed file has the total mass, center of gravity and inertia of the model at
/// its initial configuration qpos0. Other joints are locked.
///
/// MuJoCo reads URDF files. The meshes of a URDF file must be .stl or .obj files in the folder of
/// the file, in the ROS package that contains the file, or in AdaptOptions::asset_folders. Other
/// meshes are dropped, with a note.
///
/// Errors: throws InputError if the file cannot be read or does not compile. Throws InputError,
/// with a question and the option that answers it, if the model has no vehicle with four wheels or
/// with two driven wheels. Also throws InputError if its axles cannot be told apart, or if a limit
/// is missing that nothing in the model suggests. The limits of size and of the separate process
/// are those of ComposeScene and CompileScene. Cost: that of compiling the model twice.
AdaptedModel AdaptModel(const std::filesystem::path& file, const AdaptOptions& options);

}  // namespace trackbed
