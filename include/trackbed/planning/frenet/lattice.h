#pragma once

#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/frenet/frenet.h"
#include "trackbed/planning/frenet/frenet_options.h"

/// Motions along a reference path through a lattice of stations, offsets and speeds (the Frenet
/// lecture's third variant). The edges are motions of planning/frenet.h; dynamic programming finds
/// the cheapest path.
///
/// A node is a station s_j = s_0 + j spacing, an offset d_k and a speed v_m, passed parallel to the
/// path without acceleration (d' = d'' = s_tt = 0). An edge connects a node, or the start, with a
/// node of any later layer: d(s) is the quintic between the two, s(t) the quartic over the same
/// distance S. The duration is T = 2 S/(b + sqrt(b^2 + a_0 S/3)) with b = (v_0 + v_1)/2. The weight
/// of an edge is its cost C; the cost of a path is the sum over its edges.
namespace trackbed {

/// Plans the cheapest drivable path to the last layer. With StopAt, the last layer has speed 0 and
/// lies at the goal's station, if that is within the lattice. The layers before it are then closer
/// together. With FollowLeader, the cost K_s (s - S_1)^2 is added at every node, evaluated at the
/// time of arrival.
///
/// Guarantees: those of PlanFrenet, with edges in place of candidates. Every edge of the path was
/// checked at the time at which it is driven. With one layer, the result is the cheapest of
/// PlanFrenet's candidates with the same ends and durations. With more layers, the result costs at
/// most as much as the cheapest single edge to the last layer. If nothing moves, the result is
/// optimal among all paths. With moving obstacles, the result is optimal among the paths whose
/// beginnings are the cheapest to their nodes. Errors: those of PlanFrenet. Cost: 3 ms with the
/// defaults. The costs of O((layers offsets speeds)^2) edges are evaluated, and edges are checked
/// in order of cost.
FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options);

}  // namespace trackbed
