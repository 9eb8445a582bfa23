#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes the shortest path between two poses, without obstacles, of a car that drives forwards
/// and backwards with a turning radius of at least r (Reeds and Shepp 1990). The path has the form
/// of one of 48 words of at most five pieces. The words belong to the families CSC, C|C|C, CC|C,
/// C|CC, CC|CC, C|CC|C, C|CSC, CSC|C and C|CSC|C. C is an arc, S a straight and | a change between
/// forward and backward.
namespace trackbed {

/// Returns the shortest of all Reeds-Shepp words between two poses. For any two poses, at least one
/// word exists. Throws InternalError if `radius` [m] is not positive, and PreconditionError if a
/// pose is not finite. The curve ends within 1e-9 m of the pose `to`. For mirrored poses, the
/// result is the mirrored word. For exchanged poses, the result is the reversed word of the same
/// length, with every direction of travel inverted. The curve is never longer than the Dubins curve
/// between the same poses. Computing time: about a microsecond.
ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius);

/// Computes the length of the shortest Reeds-Shepp curve [m] without constructing the curve. The
/// result is exactly the length of the curve that ReedsShepp returns.
double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius);

/// Returns the shortest word of each family that can reach the pose `to`, sorted by length. A
/// longer word is an alternative if an obstacle blocks the shortest word.
std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
