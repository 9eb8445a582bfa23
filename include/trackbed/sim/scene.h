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
  std::optional<double> steering_rate;  ///< at the road wheels, instead of the car's [rad/s]
  /// Whose files the car's file may name, beside those in its own folder and below.
  std::vector<std::filesystem::path> asset_folders{};
};

/// A file the composed model refers to, under the name it is referred to by.
struct SceneAsset {
  std::string name;
  std::string content;
};

/// A complete MJCF model, exactly as simulated.
struct Scene {
  std::string xml;
  std::vector<SceneAsset> assets;
  /// For each element of `xml`, in document order, its line in the car's file, or 0 if it is not
  /// from that file. Empty when unknown.
  std::vector<int> lines;
  Ground ground{};  ///< what the geom `ground` and those on it make up
  /// Of files that come with Trackbed alone, and so compiled in this process; see CompileScene.
  bool trusted = false;
};

/// The MJCF file of a car: `model` is a name under the models folder ("prius" is
/// models/prius/prius.xml) or a path, absolute or relative to `base`. InputError with the known
/// names when there is no such file.
std::filesystem::path FindModel(const std::string& model, const std::filesystem::path& base);

/// Names that FindModel knows, sorted.
std::vector<std::string> ModelNames();

/// Where models/ and scenarios/ are: the environment variable TRACKBED_DATA; or ../share/trackbed
/// from the folder of the program, if there are models; or, for a program that links the installed
/// package, the data installed with it, and for Trackbed's own build the source tree. InputError
/// for a program that was linked to the installed static libraries without CMake, and has neither
/// of the first two.
std::filesystem::path DataFolder();

/// Reads a car's MJCF, resolves its includes, gathers the files it refers to, and sets the options.
///
/// The files that it names, includes and assets, must lie in its own folder, in one of
/// `asset_folders` or below, where links lead included. Assets are checked before MuJoCo reads
/// them: meshes are .obj or binary .stl, textures .png, height fields .png or MuJoCo's binary
/// format, none larger than 64 MB; pictures have at most 8192 x 8192 pixels, height fields 4096 x
/// 4096 samples. Skins from files are refused.
///
/// Errors: InputError with file and line when it is not XML, refers to something missing, or breaks
/// these rules.
Scene ComposeScene(const std::filesystem::path& car_file, const SceneOptions& options);

/// Adds the ground to the scene: the geom `ground` becomes the plane of the grade, and every bump
/// and side slope a height field `ground_0`, `ground_1`, … that stands on it, at most 5 cm from one
/// sample to the next, or a 256th of its side. Of a terrain there is one for each refined block,
/// with its heights, and one for each 64 x 64 blocks with the coarse heights, which lies 4 m lower
/// where there are fine ones. With those there is a plane `ground_fl`, … for every wheel that
/// touches nothing; RoadContact moves them. All take friction and the like from the car's own
/// ground. Flat ground leaves the scene as it is.
Scene WithGround(const Scene& car_scene, const Ground& ground);

/// Adds the world's obstacles, `obstacle_0`, `obstacle_1`, …, as fixed boxes, or as boxes moved by
/// the joints `obstacle_0_x` and `obstacle_0_y` where they have a velocity, the walls of its map,
/// `obstacle_wall_0`, …, as fixed boxes on flat ground, and to the car a shell
/// that only they can touch: a box geom `shell` in its body `chassis`, the footprint from a hand's
/// breadth above the ground to the roof. They stand on the world's ground. Without obstacles the
/// scene stays as it is.
Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// All of these in the world.
Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// The line in the car's file of the element at `line` of the composed text; 0 when unknown.
int LineInCarFile(const Scene& scene, int line);

/// Writes the scene to `file` (its folder must exist) and the assets beside it.
void WriteScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace trackbed
