#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes the shortest path between two poses, without obstacles, of a car that only drives
/// forwards with a turning radius of at least r (Dubins 1957). The path is one of the six words
/// LSL, RSR, LSR, RSL, LRL and RLR. The middle arc of LRL and RLR turns by more than pi.
namespace trackbed {

/// Returns the shortest of the six Dubins words between two poses. At least one word always exists.
/// Throws InternalError unless `radius` [m] is positive; PreconditionError unless the poses are
/// finite. The curve meets the end pose to 1e-9 m. Mirrored poses give the mirrored word. Exchanged
/// poses, both turned by pi, give the reversed word of the same length. Cost: a third of a
/// microsecond.
ShortestCurve Dubins(const Pose2& from, const Pose2& to, double radius);

/// Returns all Dubins words between two poses, at most six, shortest first. The longer words are
/// alternatives if an obstacle blocks the shortest word.
std::vector<ShortestCurve> DubinsWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
