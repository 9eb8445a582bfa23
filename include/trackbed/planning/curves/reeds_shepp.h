#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// The shortest path between two poses, without obstacles, of a car that drives forwards and
/// backwards with a turning radius of at least r (Reeds and Shepp 1990). The path is one of 48
/// words of at most five pieces. The families of words are CSC, C|C|C, CC|C, C|CC, CC|CC, C|CC|C,
/// C|CSC, CSC|C and C|CSC|C, where C is an arc, S a straight and | a change of direction.
namespace trackbed {

/// The shortest of all words, which always exists. InternalError unless `radius` [m] is positive;
/// PreconditionError unless the poses are finite. The curve meets the end pose to 1e-9 m. Mirrored
/// poses give the mirrored word. Exchanged poses give the reversed word of the same length, with
/// every direction inverted. The curve is never longer than the Dubins curve. Cost: about a
/// microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// The length of the curve of ReedsShepp [m], computed without the curve. The number is exactly
/// that of the curve.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// The shortest word of each family that reaches `to`, shortest first: alternatives to pass
/// obstacles.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
