#pragma once

#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/frenet/frenet.h"
#include "trackbed/planning/frenet/frenet_options.h"

/// Plans motions along a reference path through a lattice of stations, offsets and speeds (the
/// third variant of the Frenet lecture). The edges of the lattice are motions of
/// planning/frenet/frenet.h. Dynamic programming finds the cheapest path through the lattice.
///
/// A node is a station s_j = s_0 + j spacing with an offset d_k and a speed v_m. A motion passes a
/// node parallel to the path and without acceleration (d' = d'' = s_tt = 0). An edge connects a
/// node, or the start, with a node of any later layer: d(s) is the quintic polynomial between the
/// two nodes, s(t) the quartic polynomial over the distance S between the nodes. The duration of an
/// edge is T = 2 S/(b + sqrt(b^2 + a_0 S/3)) with b = (v_0 + v_1)/2, the speeds v_0 at its start
/// and v_1 at its end, and the acceleration a_0 at its start. The weight of an edge is its cost C;
/// the cost of a path is the sum over its edges.
namespace trackbed {

/// Plans the cheapest drivable path to the last layer. With StopAt, the last layer has speed 0 and
/// lies at the goal's station, if this station is within the lattice. The other layers are then
/// closer together. With FollowLeader, the cost K_s (s - S_1)^2 is added at every node, evaluated
/// at the time of arrival.
///
/// Guarantees: those of PlanFrenet, with edges in place of candidates. The planner has checked
/// every edge of the path at the time at which the car drives the edge. With one layer, the result
/// is the cheapest of PlanFrenet's candidates with the same ends and durations. With more layers,
/// the result costs at most as much as the cheapest single edge to the last layer. If no obstacle
/// moves, the result is optimal among all paths. With moving obstacles, the result is optimal among
/// the paths on which the part up to each node is the cheapest path to that node. Errors: those of
/// PlanFrenet. Cost: 3 ms with the defaults. The planner computes the costs of O((layers offsets
/// speeds)^2) edges, and checks edges in order of cost.
FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options);

}  // namespace trackbed
