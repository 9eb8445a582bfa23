#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// The shortest path of a car that turns on a radius of r or more and goes forwards and backwards,
/// between two poses and without obstacles (Reeds and Shepp 1990): one of 48 words of at most five
/// pieces, the families CSC, C|C|C, CC|C, C|CC, CC|CC, C|CC|C, C|CSC, CSC|C and C|CSC|C, where C is
/// an arc, S a straight and | a change of direction.
namespace trackbed {

/// The shortest of all. There always is one. `radius` [m] > 0 (InternalError), poses
/// finite (PreconditionError). Exact: the end is
/// met to 1e-9 m. Mirrored poses give the mirrored word; poses that change places, the word from
/// its end to its start with every direction turned: the same length. Never longer than Dubins'.
/// Cost: about a microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// Its length alone [m]: the same number.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// The word of every family that leads there, the shortest first: for ways around obstacles.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
