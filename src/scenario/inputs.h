#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Adds a problem of a key of the scenario.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Why an image that a map in `folder` names may not be read: it lies neither there nor in the
/// `others`. Empty if it may.
std::string WhyUnreadableImage(const std::filesystem::path& image,
                               const std::filesystem::path& folder,
                               const std::vector<std::filesystem::path>& others);

/// Reads the recorded drive of a scenario, its track, its map, the roads of its world, the path
/// that is to be followed and the recording that is to be replayed. Gives back the problems of
/// these files, which are placed there and follow those of the scenario; their keys are then among
/// what could not be read.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
