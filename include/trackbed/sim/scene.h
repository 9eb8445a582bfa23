#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Simulation options of a run, which override the options in the car's file.
struct SceneOptions {
  double timestep = 0.002;              ///< Timestep of the simulation [s].
  std::optional<double> steering_rate;  ///< Steering rate limit at the road wheels [rad/s], instead
                                        ///< of the car's own.
  /// Additional folders whose files the car's file may include or use as assets.
  std::vector<std::filesystem::path> asset_folders{};
};

/// A file that the composed model refers to, under the name used in the model.
struct SceneAsset {
  std::string name;
  std::string content;
};

/// A complete MJCF model, ready for simulation.
struct Scene {
  std::string xml;
  std::vector<SceneAsset> assets;
  /// For each element of `xml`, in document order, its line in the car's file; 0 for an element
  /// that is not from the car's file. The list is empty if the lines are unknown.
  std::vector<int> lines;
  Ground ground{};  ///< Shape of the ground, which the geom `ground` and the height fields on it
                    ///< represent.
  /// Whether the scene consists only of files that are shipped with Trackbed. CompileScene compiles
  /// a trusted scene in this process.
  bool trusted = false;
};

/// Returns the MJCF file of a car. `model` is either a name in the models folder ("prius" is
/// models/prius/prius.xml) or a path, which is absolute or relative to `base`. Throws InputError,
/// which lists the known names, if there is no such file.
std::filesystem::path FindModel(const std::string& model, const std::filesystem::path& base);

/// Whether FindModel interprets `model` as the path of a file and not as a name.
bool IsModelPath(const std::string& model);

/// File name of the car's composed MJCF in a run folder. The file is written if the scenario gives
/// the path of the car's file.
inline constexpr const char* kVehicleXml = "vehicle.xml";

/// Returns the names that FindModel knows, sorted.
std::vector<std::string> ModelNames();

/// Returns the folder that contains models/ and scenarios/. The folder is the first of these that
/// applies: the environment variable TRACKBED_DATA; ../share/trackbed relative to the program's
/// folder, if it contains models; the data of the installed package, for a program that links the
/// package; the source tree, for Trackbed's build. A program that was linked to the installed
/// static libraries without CMake can use only the first two. Throws InputError if no folder
/// applies.
std::filesystem::path DataFolder();

/// Reads a car's MJCF file, resolves its includes, collects the files it refers to, and sets the
/// simulation options.
///
/// Included files and assets must be in or below the folder of the car's file or one of
/// SceneOptions::asset_folders, after symbolic links are resolved. Assets are checked before MuJoCo
/// reads them: meshes must be .obj or binary .stl files, textures .png files, and height fields
/// .png files or files in MuJoCo's binary format. No asset may be larger than 64 MB. Images may
/// have at most 8192 x 8192 pixels, and height fields at most 4096 x 4096 samples. Skins from files
/// are rejected. If a composed model is composed again with the same options, the result is the
/// same.
///
/// Errors: InputError, with file and line, for invalid XML, missing files or a violation of these
/// rules.
Scene ComposeScene(const std::filesystem::path& car_file, const SceneOptions& options);

/// Adds the ground to the scene. The geom `ground` becomes a plane with the ground's grade. Every
/// bump and side slope becomes a height field on this plane, named `ground_0`, `ground_1`, … The
/// samples of a height field are at most 5 cm, or a 256th of its side, apart. A terrain has one
/// height field for each refined block, and one coarse height field for each group of 64 x 64
/// blocks. The coarse heights are lowered by 4 m within refined blocks. If there are height fields,
/// every wheel also gets a plane (`ground_fl`, …) without contacts, which RoadContact moves. Planes
/// and height fields have the friction and other properties of the car's ground geom. Flat ground
/// leaves the scene unchanged.
Scene WithGround(const Scene& car_scene, const Ground& ground);

/// Adds the world's obstacles `obstacle_0`, `obstacle_1`, … to the scene, as fixed boxes. Obstacles
/// with a velocity are boxes with joints such as `obstacle_0_x` and `obstacle_0_y`, along which
/// they move. The walls of the world's map (`obstacle_wall_0`, …) are fixed boxes on flat ground.
/// The body `chassis` of the car gets a box geom `shell`, which can touch only obstacles. The shell
/// has the length and width of the car's footprint, and extends from a tenth of the car's height
/// above the ground to the roof. Obstacles stand on the world's ground. Without obstacles, the
/// scene is unchanged.
Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// Adds the world's ground and obstacles to the scene.
Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// Returns the line, in the car's file, of the element that is at `line` in the composed text; 0 if
/// unknown.
int LineInCarFile(const Scene& scene, int line);

/// Writes the scene to `file`, whose folder must exist, and the assets to the same folder. An
/// existing `file` is replaced, but assets are not: if a file with other content has the name of an
/// asset, WriteScene throws RunError.
void WriteScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace trackbed
