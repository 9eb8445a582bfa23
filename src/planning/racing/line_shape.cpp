#include "src/planning/racing/line_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trackbed {

ClosedSplineBasis OffsetBasis(const Track& track) {
  constexpr std::size_t kKnotsPerPoint = 2;
  return {track.length(), kKnotsPerPoint * track.points().size()};
}

LineShape ShapeAt(const PathPoint& center, const LineOffset& offset) {
  const OffsetDerivatives d(offset.d, 3, 0);
  const OffsetDerivatives slope(offset.slope, 3, 1);
  const OffsetDerivatives bend(offset.bend, 3, 2);
  const OffsetDerivatives along = 1.0 - center.curvature * d;
  // The second derivative r'' has the tangential part `along_rate` and the normal part
  // `across_rate`.
  const OffsetDerivatives along_rate =
      -(center.sharpness * d + 2.0 * center.curvature * slope);  // tangential
  const OffsetDerivatives across_rate = bend + center.curvature * along;
  return {.cross = along * across_rate - slope * along_rate,
          .square = along * along + slope * slope};
}

OffsetBounds BoundsAt(const Track& track, const PathPoint& center, double s, double beside) {
  constexpr double kMaxRadiusFraction =
      0.95;  // Largest permitted |d| as a fraction of the center line's radius of curvature.
  const TrackEdges edges = track.EdgesAt(s);
  OffsetBounds bounds{edges.right + beside, edges.left - beside};
  if (center.curvature > 0.0) {
    bounds.upper = std::min(bounds.upper, kMaxRadiusFraction / center.curvature);
  } else {
    bounds.lower = std::max(bounds.lower, kMaxRadiusFraction / std::min(center.curvature, -1e-12));
  }
  return bounds;
}

std::string TooNarrow(const Track& track, double s, double beside) {
  const TrackEdges edges = track.EdgesAt(s);
  return fmt::format(
      "the track is {:.3g} m wide at s = {:.4g} m; the car and its margins need "
      "{:.3g} m",
      edges.left - edges.right, s, 2.0 * beside);
}

std::string RemedyForNarrowTrack(double room, double car_width) {
  // Round the margin down to centimeters, so that the track certainly has room for this margin.
  const double margin = std::floor(100.0 * (room - 0.5 * car_width) - 0.1) / 100.0;
  return margin >= 0.0 ? fmt::format("plan.margin must be at most {:.2f} m", margin)
                       : fmt::format(
                             "the car alone is {:.3g} m wide and needs a narrower body or a wider "
                             "track",
                             car_width);
}

}  // namespace trackbed
