#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Type of the function that reports a problem of a key in the scenario.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Adds Trackbed's data folder to the folders from which files may be read.
std::vector<std::filesystem::path> WithOwnData(std::vector<std::filesystem::path> folders);

/// Checks that the YAML file of a map in `folder` may name an image: the image must lie in `folder`
/// or in one of the folders `others`. Returns an error message if the image of the map must not be
/// read, otherwise an empty text.
std::string ImageAccessError(const std::filesystem::path& image,
                             const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& others);

/// Reads the files that a scenario names: recorded drive, track, map, road network, path to follow
/// and recording to replay. ReadInputs returns the problems that it found inside the input files.
/// Callers must report the problems inside the input files after the problems of the scenario file.
/// ReadInputs marks the keys that name files with problems as unread.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
