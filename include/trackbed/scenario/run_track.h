#pragma once

#include <filesystem>

#include "trackbed/track/track.h"

namespace trackbed {

/// The track of a run, from `track.csv` in its folder, with the smoothing of the run's scenario.
/// Throws the errors of ReadTrack and ReadScenario.
Track ReadRunTrack(const std::filesystem::path& track_csv, const std::filesystem::path& scenario);

}  // namespace trackbed
