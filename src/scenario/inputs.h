#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Reports a problem of a key of the scenario.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Why an image that a map in `folder` names may not be read: it lies neither in `folder` nor in
/// one of the `others`. Empty if it may be read.
std::string ImageAccessError(const std::filesystem::path& image,
                             const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& others);

/// Reads the files of a scenario: recorded drive, track, map, road network, path to follow and
/// recording to replay. Returns the problems inside these files, to be listed after those of the
/// scenario. Marks the keys of such files as unread.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
