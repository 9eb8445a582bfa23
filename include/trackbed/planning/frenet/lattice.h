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
/// node of any later layer: d(s) is the quintic between them, s(t) the quartic over the same
/// distance S, T = 2 S/(b + sqrt(b^2 + a_0 S/3)) with b = (v_0 + v_1)/2. Its weight is C; the cost
/// of a path is the sum over its edges.
namespace trackbed {

/// The cheapest drivable path to the last layer. With StopAt, the last layer is at the goal's
/// station, if that lies within the lattice, with speed 0; the layers before it are then closer
/// together. With FollowLeader, K_s (s - S_1)^2 is added at every node, at its time of arrival.
///
/// Guarantees: those of PlanFrenet, with edges for candidates; every edge of the path was checked
/// at the time at which it is driven. With one layer, the result is the cheapest of PlanFrenet's
/// candidates with the same ends and durations; with more, it costs at most as much as the cheapest
/// single edge to the last layer. It is optimal among all paths if nothing moves; otherwise among
/// those whose beginnings are the cheapest to their nodes. Errors: as PlanFrenet. Cost: 3 ms with
/// the defaults; evaluates the costs of O((layers offsets speeds)^2) edges, and checks edges in
/// order of cost.
FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options);

}  // namespace trackbed
