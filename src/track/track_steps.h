#pragma once

#include <cstddef>
#include <vector>

#include "src/track/track_rows.h"
#include "trackbed/track/track.h"

namespace trackbed {

/// Distances of the points of a closed track from the next points [m].
struct TrackSteps {
  std::vector<double> lengths;
  double median = 0.0;

  /// Whether the step is so long that a smooth curve may swing aside between its ends.
  [[nodiscard]] bool IsLong(std::size_t i) const { return lengths[i] > 4.0 * median; }
};

/// Returns the steps between the points; there must be at least one point.
TrackSteps StepsOf(const std::vector<TrackPoint>& points);

/// Adds points on the straight lines of long steps, with a note.
void FillLongSteps(TrackRows& rows);

}  // namespace trackbed
