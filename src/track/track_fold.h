#pragma once

#include <cstddef>

#include "trackbed/track/track.h"

namespace trackbed {

/// Largest distance of the inner edge of a bend from the center line, as a fraction of the radius.
inline constexpr double kMaxRadiusFraction = 0.95;

/// The default wavelength of the smoothing of a center line, in mean distances of its points.
inline constexpr double kDefaultSmoothing = 4.0;

/// Number of stations from each surveyed point to the next at which FindFold examines a track.
inline constexpr int kFoldSamples = 4;

/// Returns the station of such a place, `sample` of kFoldSamples after a point [m].
double StationOfSample(const Track& track, std::size_t point, int sample);

}  // namespace trackbed
