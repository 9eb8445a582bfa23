#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "trackbed/sim/scene.h"

/// Reads the files of a car, which may be untrusted: its MJCF file, included files and assets.
namespace trackbed::scene_files {

/// Path of the car's file, and the folders from which the file may include other files.
struct Origin {
  std::filesystem::path file;
  std::filesystem::path folder;  ///< folder that contains the car's file
  const std::vector<std::filesystem::path>& others;
  bool& shipped;  ///< whether all files read so far are shipped with Trackbed
};

/// Throws InputError that names a file and the line of the error.
[[noreturn]] void Fail(const std::filesystem::path& file, int line, std::string message);

/// Reads the XML file `file` into `document`. If the file is not shipped with Trackbed, sets
/// `shipped` to false.
void Load(const std::filesystem::path& file, tinyxml2::XMLDocument& document, bool& shipped);

/// Replaces every <include file="…"/> below `parent`, an element of `file`, by the children of the
/// included file's root element. As in MuJoCo, the names of included files are relative to the main
/// file, and each file may be included only once.
void ResolveIncludes(tinyxml2::XMLElement& parent, const std::filesystem::path& file,
                     const Origin& origin, std::set<std::filesystem::path>& included);

/// Collects the files that assets refer to, and replaces the references by plain file names. With
/// plain file names, the composed model and its assets can be written into a common folder.
void GatherAssets(tinyxml2::XMLElement& root, const Origin& origin, Scene& scene);

}  // namespace trackbed::scene_files
