#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// The shortest path of a car that turns on a radius of r or more and only goes forwards, between
/// two poses and without obstacles (Dubins 1957): one of the six words LSL, RSR, LSR, RSL, LRL and
/// RLR, of which the middle arc of the last two turns by more than pi.
namespace trackbed {

/// The shortest of the six. There always is one. `radius` [m] > 0 (InternalError), poses
/// finite (PreconditionError). Exact: the end
/// is met to 1e-9 m. Mirrored poses give the mirrored word; poses that change places and are turned
/// by pi give the word backwards: the same length. Cost: a third of a microsecond.
ShortestCurve Dubins(const Pose2& from, const Pose2& to, double radius);

/// Every word that there is between two poses, at most six, the shortest first: for ways around
/// obstacles.
std::vector<ShortestCurve> DubinsWords(const Pose2& from, const Pose2& to, double radius);

}  // namespace trackbed
