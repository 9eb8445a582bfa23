#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes the shortest path between two poses, without obstacles, of a car that drives forwards
/// and backwards with a turning radius of at least r (Reeds and Shepp 1990). The path is one of 48
/// words of at most five pieces. The families of words are CSC, C|C|C, CC|C, C|CC, CC|CC, C|CC|C,
/// C|CSC, CSC|C and C|CSC|C, where C is an arc, S a straight and | a change of direction.
namespace trackbed {

/// Returns the shortest of all Reeds-Shepp words between two poses. At least one word always
/// exists. Throws InternalError unless `radius` [m] is positive; PreconditionError unless the poses
/// are finite. The curve meets the end pose to 1e-9 m. Mirrored poses give the mirrored word.
/// Exchanged poses give the reversed word of the same length, with every direction inverted. The
/// curve is never longer than the Dubins curve. Cost: about a microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// Computes the length of the shortest Reeds-Shepp curve [m] without constructing the curve. The
/// result equals the length of the curve of ReedsShepp exactly.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// Returns the shortest word of each family that reaches `to`, shortest first. The longer words are
/// alternatives if an obstacle blocks the shortest word.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
