#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Simulation options of a run, which override the options in the car's file.
struct SceneOptions {
  double timestep = 0.002;  ///< Timestep of the simulation [s].
  /// Limit of the steering rate at the road wheels [rad/s], which replaces the limit in the car's
  /// file.
  std::optional<double> steering_rate;
  /// Numbers that describe the tyres, under their names in the <custom> section of a car's file
  /// (ReadTyreFiles). Unless `tyre_numbers` is empty, its numbers replace all tyre coefficients in
  /// the car's file.
  std::vector<std::pair<std::string, double>> tyre_numbers{};
  /// Additional folders; the car's file may include files from these folders or use them as assets.
  std::vector<std::filesystem::path> asset_folders{};
};

/// A file to which the composed model refers, with the name that the model uses for the file.
struct SceneAsset {
  std::string name;
  std::string content;
};

/// A complete MJCF model, ready for simulation.
struct Scene {
  std::string xml;
  std::vector<SceneAsset> assets;
  /// Line in the car's file from which each element of `xml` originates, in document order; 0 for
  /// an element that is not from the car's file. The list `lines` is empty if the lines of the XML
  /// elements are unknown.
  std::vector<int> lines;
  /// Shape of the ground that the geom `ground` and the height fields in the model represent.
  Ground ground{};
  /// Whether the scene consists only of files that are shipped with Trackbed. CompileScene compiles
  /// a trusted scene in this process instead of in a separate process.
  bool trusted = false;
};

/// Returns the path of a car's MJCF file. The argument `model` is either a name in the models
/// folder ("prius" stands for models/prius/prius.xml) or a path, which is absolute or relative to
/// `base`. If the model's file does not exist, throws InputError, which lists the known model
/// names.
std::filesystem::path FindModel(const std::string& model, const std::filesystem::path& base);

/// Whether FindModel interprets `model` as a path and not as the name of a model.
bool IsModelPath(const std::string& model);

/// File name of the car's composed MJCF in a run folder. The run folder contains the composed MJCF
/// if the scenario specifies the car by the path of a file.
inline constexpr const char* kVehicleXml = "vehicle.xml";

/// Returns the names of all models that FindModel knows, sorted.
std::vector<std::string> ModelNames();

/// Returns the folder that contains models/ and scenarios/. The folder in the environment variable
/// TRACKBED_DATA has priority. Without this variable, the data folder is ../share/trackbed relative
/// to the program's folder, if that folder contains models. Without TRACKBED_DATA and such a
/// folder, a program that links the package uses the data of the installed package, and a program
/// in Trackbed's build uses the source tree. A program that was linked to the installed static
/// libraries without CMake finds only the data folder of TRACKBED_DATA or ../share/trackbed. Throws
/// InputError if the program finds no data folder.
std::filesystem::path DataFolder();

/// Reads a car's MJCF file, resolves its includes, collects the asset files, and sets the
/// simulation options.
///
/// Included files and assets must be in or below the folder of the car's file or one of
/// SceneOptions::asset_folders; symbolic links are resolved before this check. The types of assets
/// are checked before MuJoCo reads the files. Meshes must be .obj or binary .stl files, textures
/// must be .png files, and height fields must be .png files or files in MuJoCo's binary format. No
/// asset may be larger than 64 MB. Images may have at most 8192 x 8192 pixels, and height fields at
/// most 4096 x 4096 samples. ComposeScene rejects skins that MuJoCo would read from files.
/// ComposeScene does not change a model that it has already composed with the same options.
///
/// Errors: throws InputError, with file and line, if the XML is invalid, if a file is missing, or
/// if a file or asset violates the rules above.
Scene ComposeScene(const std::filesystem::path& car_file, const SceneOptions& options);

/// Converts a line of the composed text to the line in the car's file that defines the same
/// element; returns 0 if the line is unknown.
int LineInCarFile(const Scene& scene, int line);

/// Writes the scene to `file`, and the scene's assets to the folder of `file`, which must exist.
/// WriteScene replaces an existing `file`, but no existing assets; if a file with the name of an
/// asset has different content, WriteScene throws RunError.
void WriteScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace trackbed
