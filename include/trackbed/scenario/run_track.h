#pragma once

#include <filesystem>

#include "trackbed/track/track.h"

namespace trackbed {

/// Reads the track of a run from `track.csv` in the run folder, and applies the smoothing that the
/// run's scenario sets. Throws the same errors as ReadTrack and ReadScenario.
Track ReadRunTrack(const std::filesystem::path& track_csv, const std::filesystem::path& scenario);

}  // namespace trackbed
