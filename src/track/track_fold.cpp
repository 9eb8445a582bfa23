#include "src/track/track_fold.h"

#include <cmath>

namespace trackbed {

double StationOfSample(const Track& track, std::size_t point, int sample) {
  const bool is_last = point + 1 == track.points().size();
  const double to = is_last ? track.length() : track.StationOf(point + 1);
  return std::lerp(track.StationOf(point), to, static_cast<double>(sample) / kFoldSamples);
}

}  // namespace trackbed
