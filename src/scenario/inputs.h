#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Callback that reports a problem of a scenario's key.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Checks that a map in `folder` may refer to an image: the image must lie in `folder` or in one of
/// the folders `others`. Returns the reason if the image must not be read, otherwise an empty text.
std::string ImageAccessError(const std::filesystem::path& image,
                             const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& others);

/// Reads the files that a scenario names: recorded drive, track, map, road network, path to follow
/// and recording to replay. ReadInputs returns the problems inside the files. Callers list these
/// problems after the problems of the scenario file. Keys of files with problems are marked as
/// unread.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
