#pragma once

#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/frenet/frenet.h"
#include "trackbed/planning/frenet/frenet_options.h"

/// Motions along a reference path through a lattice of stations, offsets and speeds (the Frenet
/// lecture's third variant): the edges are motions of planning/frenet.h, the cheapest path is found
/// by dynamic programming.
///
/// A node is a station s_j = s_0 + j spacing, an offset d_k and a speed v_m, passed along the path
/// without acceleration (d' = d'' = s_tt = 0). An edge leads from a node, or the start, to one of
/// any later layer: d(s) is the quintic between them, s(t) the quartic over the same distance S,
/// T = 2 S/(b + sqrt(b^2 + a_0 S/3)) with b = (v_0 + v_1)/2. Its weight is C; a path
/// costs the sum of its edges.
namespace trackbed {

/// The cheapest path to the last layer that can be driven. With StopAt the last layer is at its
/// station, if that lies within the lattice, and the speed there 0; the layers before are closer to
/// each other then. With FollowLeader, K_s (s - S_1)^2 counts at every node when it is reached.
///
/// Guarantees: those of PlanFrenet, with edges for candidates; every edge of the path was checked
/// at the time at which it is driven. With one layer, the cheapest of PlanFrenet's candidates with
/// the same ends and durations; with more, never dearer than the cheapest edge that leads straight
/// to the last layer. The optimum among all paths when nothing moves; else among those whose
/// beginnings are the cheapest to their nodes. Errors: as PlanFrenet. Cost: 3 ms with the defaults;
/// O((layers offsets speeds)^2) costs of edges, and checks of those that are tried, cheapest first.
FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options);

}  // namespace trackbed
