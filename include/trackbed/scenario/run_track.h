#pragma once

#include <filesystem>

#include "trackbed/track/track.h"

namespace trackbed {

/// The track of a run, from the `track.csv` of its folder, smoothed as the run's scenario says.
/// Errors: those of ReadTrack and ReadScenario.
Track ReadRunTrack(const std::filesystem::path& track_csv, const std::filesystem::path& scenario);

}  // namespace trackbed
