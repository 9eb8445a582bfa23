#pragma once

#include <cstddef>

#include "trackbed/track/track.h"

namespace trackbed {

/// Largest distance of the inner edge of a bend from the center line, as a fraction of the center
/// line's radius.
inline constexpr double kMaxRadiusFraction = 0.95;

/// Default wavelength of the smoothing of a center line, as a multiple of the mean distance between
/// its points.
inline constexpr double kDefaultSmoothing = 4.0;

/// Number of stations from each surveyed point to the next at which FindFold examines a track.
inline constexpr int kFoldSamples = 4;

/// Returns the station of the sample number `sample` (0 to kFoldSamples - 1) between a track point
/// and the next one [m].
double StationOfSample(const Track& track, std::size_t point, int sample);

}  // namespace trackbed
