#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes the shortest path between two poses, without obstacles, of a car that only drives
/// forwards with a turning radius of at least r (Dubins 1957). The Dubins path has the form of one
/// of the six words LSL, RSR, LSR, RSL, LRL and RLR. In a Dubins word, L is a left arc, R a right
/// arc and S a straight. In the Dubins words LRL and RLR, the middle arc turns by more than pi.
namespace trackbed {

/// Returns the shortest of the six Dubins curves between two poses. For any two poses, at least one
/// Dubins curve exists. Throws InternalError if `radius` [m] is not positive, and PreconditionError
/// if a pose is not finite. The curve ends within 1e-9 m of the pose `to`. For mirrored poses, the
/// result is the mirrored curve. If both poses are exchanged and turned by pi, the result is the
/// reversed curve of the same length. Computing time: a third of a microsecond.
ShortestCurve Dubins(const Pose2& from, const Pose2& to, double radius);

/// Returns all Dubins curves between two poses, at most six, shortest first. A longer curve is an
/// alternative if an obstacle blocks the shortest curve.
std::vector<ShortestCurve> DubinsWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
