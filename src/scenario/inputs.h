#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Callback that reports a problem of a key of the scenario.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Reason why an image named by a map in `folder` may not be read: it lies neither in `folder` nor
/// in one of the `others`. The reason is empty if the image may be read.
std::string ImageAccessError(const std::filesystem::path& image,
                             const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& others);

/// Reads the files of a scenario: recorded drive, track, map, road network, path to follow and
/// recording to replay. ReadInputs returns the problems inside the files, to be listed after the
/// scenario's own problems. Keys of files with problems are marked as unread.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
