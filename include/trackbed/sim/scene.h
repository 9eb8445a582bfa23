#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Simulation options of a run. The options override those in the car's file.
struct SceneOptions {
  double timestep = 0.002;              ///< Timestep [s].
  std::optional<double> steering_rate;  ///< Rate at the road wheels [rad/s]; overrides the car's.
  /// Folders whose files the car's file may refer to, in addition to the folder of the car's file.
  std::vector<std::filesystem::path> asset_folders{};
};

/// A file that the composed model refers to, with its name in the model.
struct SceneAsset {
  std::string name;
  std::string content;
};

/// A complete MJCF model in the form that is simulated.
struct Scene {
  std::string xml;
  std::vector<SceneAsset> assets;
  /// Lines in the car's file of the elements of `xml`, in document order. 0 for an element from
  /// elsewhere. Empty if unknown.
  std::vector<int> lines;
  Ground ground{};  ///< Shape of the geom `ground` and the geoms on it.
  /// Whether the scene consists only of files that come with Trackbed. A trusted scene is compiled
  /// in this process (CompileScene).
  bool trusted = false;
};

/// The MJCF file of a car: `model` is a name under the models folder ("prius" is
/// models/prius/prius.xml) or a path, absolute or relative to `base`. InputError with the known
/// names if there is no such file.
std::filesystem::path FindModel(const std::string& model, const std::filesystem::path& base);

/// Whether FindModel interprets `model` as the path of a file and not as a name.
bool IsModelPath(const std::string& model);

/// Name of the car's composed MJCF in a run folder, if the scenario names the car by its path.
inline constexpr const char* kVehicleXml = "vehicle.xml";

/// Names that FindModel knows, sorted.
std::vector<std::string> ModelNames();

/// The folder that contains models/ and scenarios/. The folder is the first of these that applies:
/// the environment variable TRACKBED_DATA; ../share/trackbed relative to the program's folder, if
/// it contains models; the data of the installed package, for a program that links the package; the
/// source tree, for Trackbed's build. A program that was linked to the installed static libraries
/// without CMake can only use the first two; otherwise InputError.
std::filesystem::path DataFolder();

/// Reads a car's MJCF, resolves its includes, collects the files it refers to, and sets the
/// options.
///
/// Included files and assets must lie in or below the car file's folder or one of `asset_folders`,
/// after following links. Assets are checked before MuJoCo reads them: meshes must be .obj or
/// binary .stl, textures .png, height fields .png or MuJoCo's binary format. No asset may be larger
/// than 64 MB. Images have at most 8192 x 8192 pixels, height fields 4096 x 4096 samples. Skins
/// from files are rejected. Composing a composed model again, with the same options, leaves it
/// unchanged.
///
/// Errors: InputError with file and line for invalid XML, missing files, or a violation of these
/// rules.
Scene ComposeScene(const std::filesystem::path& car_file, const SceneOptions& options);

/// Adds the ground to the scene. The geom `ground` becomes the plane of the grade; every bump and
/// side slope becomes a height field `ground_0`, `ground_1`, … on the plane. The samples are at
/// most 5 cm, or a 256th of the side, apart. A terrain has one height field for each refined block,
/// and one for each 64 x 64 blocks with the coarse heights. The coarse heights are lowered by 4 m
/// within refined blocks. With height fields, every wheel has a plane `ground_fl`, … without
/// contacts, which RoadContact moves. Planes and height fields have the friction and other
/// properties of the car's ground geom. Flat ground leaves the scene unchanged.
Scene WithGround(const Scene& car_scene, const Ground& ground);

/// Adds the world's obstacles, `obstacle_0`, `obstacle_1`, …, as fixed boxes. Obstacles with a
/// velocity are boxes moved by the joints `obstacle_0_x` and `obstacle_0_y`. The walls of the
/// world's map, `obstacle_wall_0`, …, are fixed boxes on flat ground. Adds a shell to the car that
/// only obstacles can touch: a box geom `shell` in the body `chassis`. The shell has the length and
/// width of the footprint, and extends from a tenth of the car's height above the ground to the
/// roof. Obstacles stand on the world's ground. Without obstacles the scene is unchanged.
Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// Adds the world's ground and obstacles to the scene.
Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// The line in the car's file of the element at `line` of the composed text; 0 if unknown.
int LineInCarFile(const Scene& scene, int line);

/// Writes the scene to `file`, whose folder must exist, and the assets to the same folder. Only
/// `file` is replaced: RunError if a file with other content has the name of an asset.
void WriteScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace trackbed
