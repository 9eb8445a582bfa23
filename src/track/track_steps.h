#pragma once

#include <cstddef>
#include <vector>

#include "src/track/track_rows.h"
#include "trackbed/track/track.h"

namespace trackbed {

/// Deviations of the smoothed line from the points and from the straight lines between them.
struct LineDeviations {
  double largest = 0.0;               // Largest distance of a point from the line [m].
  std::vector<std::size_t> swinging;  // Points after which the line swings aside.
};

/// Finds the deviations before a Track is made. The line swings aside on the step after a point if
/// the distance from the straight line exceeds both of two values: `tolerance` [m], and the
/// plausible height of an arc. At steps of the lengths a and b that turn by phi, arcs of equal
/// heights over both steps are phi a b / (4 (a + b)) high; the larger height at both ends counts.
LineDeviations FindDeviations(const std::vector<TrackPoint>& points, double smoothing,
                              double tolerance);

/// Returns the length of the shortest of the given steps [m].
double ShortestStep(const std::vector<TrackPoint>& points, const std::vector<std::size_t>& steps);

/// Adds the middle of each given step to the points, with the mean of the widths.
void AddMiddles(TrackRows& rows, const std::vector<std::size_t>& steps);

}  // namespace trackbed
