#pragma once

#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// A point of a lane's center line, with heading and curvature in driving direction.
struct CenterPoint {
  Vec2 position{0.0, 0.0};
  CurvePoint curve;  ///< distance along the center line, heading and curvature at the point
};

/// Points along a piece of a lane's center line; the piece has no kinks.
using Piece = std::vector<CenterPoint>;

/// Largest deviation of a path from the lane centers that is not corrected [m]. Where the path
/// deviates farther, CloseGaps moves the path back to the lane centers.
constexpr double kKeptOffset = 1e-3;

/// Returns the length over which a path moves sideways by `offset` [m], such that the move adds at
/// most 1e-3 1/m to the curvature [m].
double ClosingLength(double offset);

/// Moves the path through the points in `runs` back to the positions of these points. A path is
/// built from headings and curvatures, so each gap between pieces and each rounded kink moves the
/// rest of the path aside. Where a path deviates by more than kKeptOffset, CloseGaps changes
/// headings, curvatures and distances of the points. The changed part of the path has the length
/// ClosingLength(), half before and half after the deviating point. The points in `runs` get the
/// positions of the moved path. The start of the path is not moved. Returns whether any point was
/// changed. `path` is the path through the points in `runs`. The computing time is O(n log n) for n
/// points.
bool CloseGaps(const Path& path, std::vector<Piece>& runs);

}  // namespace trackbed
