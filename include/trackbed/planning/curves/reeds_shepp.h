#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes the shortest path between two poses, without obstacles, of a car that drives forwards
/// and backwards with a turning radius of at least r (Reeds and Shepp 1990). The Reeds-Shepp path
/// has the form of one of 48 words (sequences) of at most five pieces. The 48 Reeds-Shepp words
/// belong to the families CSC, C|C|C, CC|C, C|CC, CC|CC, C|CC|C, C|CSC, CSC|C and C|CSC|C. In the
/// names of the families, C is an arc, S a straight and | a change between forward and backward.
namespace trackbed {

/// Returns the shortest of all Reeds-Shepp curves between two poses. For any two poses, at least
/// one Reeds-Shepp curve exists. Throws InternalError if `radius` [m] is not positive, and
/// PreconditionError if a pose is not finite. The curve ends within 1e-9 m of the pose `to`. For
/// mirrored poses, the result is the mirrored curve. For exchanged poses, the result is the
/// reversed curve of the same length, with every direction of travel inverted. The Reeds-Shepp
/// curve is never longer than the Dubins curve between the same poses. Computing time: about a
/// microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// Computes the length of the shortest Reeds-Shepp curve [m] without constructing the curve. The
/// returned length is exactly that of the curve that ReedsShepp returns.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// Returns the shortest Reeds-Shepp curve of each family that can reach the pose `to`, sorted by
/// length. A longer curve is an alternative if an obstacle blocks the shortest curve.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
