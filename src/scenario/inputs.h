#pragma once

#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Adds a problem of a key of the scenario.
using AddKeyError = std::function<void(const std::string& key, std::string message)>;

/// Reads the recorded drive of a scenario, its track, its map, the roads of its world, the path
/// that is to be followed and the recording that is to be replayed. Gives back the problems of
/// these files, which are placed there and follow those of the scenario; their keys are then among
/// what could not be read.
std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error);

}  // namespace trackbed
