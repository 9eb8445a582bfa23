#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Simulation options of a run; they override those in the car's file.
struct SceneOptions {
  double timestep = 0.002;              ///< [s]
  std::optional<double> steering_rate;  ///< at the road wheels, overrides the car's [rad/s]
  /// Folders whose files the car's file may refer to, in addition to its folder.
  std::vector<std::filesystem::path> asset_folders{};
};

/// A file that the composed model refers to, with its name there.
struct SceneAsset {
  std::string name;
  std::string content;
};

/// A complete MJCF model, exactly as simulated.
struct Scene {
  std::string xml;
  std::vector<SceneAsset> assets;
  /// For each element of `xml`, in document order, its line in the car's file, or 0 if it comes
  /// from elsewhere. Empty if unknown.
  std::vector<int> lines;
  Ground ground{};  ///< shape of the geom `ground` and the geoms on it
  /// Made only of files that come with Trackbed, and therefore compiled in this process; see
  /// CompileScene.
  bool trusted = false;
};

/// The MJCF file of a car: `model` is a name under the models folder ("prius" is
/// models/prius/prius.xml) or a path, absolute or relative to `base`. InputError with the known
/// names if there is no such file.
std::filesystem::path FindModel(const std::string& model, const std::filesystem::path& base);

/// Whether FindModel takes `model` for the path of a file, not for a name.
bool IsModelPath(const std::string& model);

/// Name of the car's composed MJCF in a run folder, if the scenario gave the path of a car.
inline constexpr const char* kVehicleXml = "vehicle.xml";

/// Names that FindModel knows, sorted.
std::vector<std::string> ModelNames();

/// The folder of models/ and scenarios/, the first that applies: the environment variable
/// TRACKBED_DATA; ../share/trackbed relative to the program's folder, if it has models; for a
/// program that links the installed package, the data installed with it; for Trackbed's build, the
/// source tree. InputError for a program that was linked to the installed static libraries without
/// CMake, if neither of the first two applies.
std::filesystem::path DataFolder();

/// Reads a car's MJCF, resolves its includes, collects the files it refers to, and sets the
/// options.
///
/// Included files and assets must lie in or below the car file's folder or one of `asset_folders`,
/// after following links. Assets are checked before MuJoCo reads them: meshes must be .obj or
/// binary .stl, textures .png, height fields .png or MuJoCo's binary format, none larger than 64
/// MB; images have at most 8192 x 8192 pixels, height fields 4096 x 4096 samples. Skins from files
/// are rejected. A composed model is composed to itself, with the same options.
///
/// Errors: InputError with file and line for invalid XML, missing files, or a violation of these
/// rules.
Scene ComposeScene(const std::filesystem::path& car_file, const SceneOptions& options);

/// Adds the ground to the scene. The geom `ground` becomes the plane of the grade; every bump and
/// side slope becomes a height field `ground_0`, `ground_1`, … on it, with samples at most 5 cm, or
/// a 256th of its side, apart. A terrain has one height field for each refined block, with its
/// heights, and one for each 64 x 64 blocks with the coarse heights, lowered by 4 m where there are
/// fine ones. With height fields, every wheel has a plane `ground_fl`, … without contacts, which
/// RoadContact moves. All of them take friction and other properties from the car's ground geom.
/// Flat ground leaves the scene unchanged.
Scene WithGround(const Scene& car_scene, const Ground& ground);

/// Adds the world's obstacles, `obstacle_0`, `obstacle_1`, …, as fixed boxes, or, if they have a
/// velocity, as boxes moved by the joints `obstacle_0_x` and `obstacle_0_y`; and the walls of its
/// map, `obstacle_wall_0`, …, as fixed boxes on flat ground. Adds a shell to the car that only they
/// can touch: a box geom `shell` in its body `chassis`, with the length and width of the footprint,
/// from a tenth of the car's height above the ground to the roof. Obstacles stand on the world's
/// ground. Without obstacles the scene is unchanged.
Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// Adds the world's ground and obstacles to the scene.
Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// The line in the car's file of the element at `line` of the composed text; 0 if unknown.
int LineInCarFile(const Scene& scene, int line);

/// Writes the scene to `file` (its folder must exist) and the assets beside it. RunError when an
/// asset's name is taken by a file with other content: only `file` is replaced.
void WriteScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace trackbed
