#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// The shortest path, between two poses and without obstacles, of a car that drives forwards and
/// backwards with a turning radius of at least r (Reeds and Shepp 1990): one of 48 words of at most
/// five pieces, the families CSC, C|C|C, CC|C, C|CC, CC|CC, C|CC|C, C|CSC, CSC|C and C|CSC|C, where
/// C is an arc, S a straight and | a change of direction.
namespace trackbed {

/// The shortest of all words; it always exists. `radius` [m] > 0 (InternalError), poses finite
/// (PreconditionError). Exact: the end is met to 1e-9 m. Mirrored poses give the mirrored word;
/// exchanged poses give the reversed word with every direction inverted, of the same length. Never
/// longer than Dubins'. Cost: about a microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// The length of ReedsShepp [m], without the curve; the same number.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// The word of each family that reaches `to`, shortest first: alternatives to pass obstacles.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
