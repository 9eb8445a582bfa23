#pragma once

#include <filesystem>

#include "trackbed/track/track.h"

namespace trackbed {

/// The track of a run, from `track.csv` in its folder, with the smoothing of the run's scenario.
/// Errors: those of ReadTrack and ReadScenario.
Track ReadRunTrack(const std::filesystem::path& track_csv, const std::filesystem::path& scenario);

}  // namespace trackbed
