#pragma once

#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/frenet/frenet.h"
#include "trackbed/planning/frenet/frenet_options.h"

/// Plans motions along a reference path through a lattice of stations, offsets and speeds (the
/// third variant of the Frenet lecture). The edges of the lattice are motions as in
/// planning/frenet/frenet.h. Dynamic programming finds the cheapest path through the lattice.
///
/// A node of the lattice consists of a station s_j = s_0 + j spacing (s_0: station of the start),
/// an offset d_k and a speed v_m. At a node, the car moves parallel to the path and without
/// acceleration (d' = d'' = s_tt = 0). An edge connects the start or a node with a node of any
/// later layer. On an edge, the offset d(s) is the quintic polynomial between the two nodes, and
/// the station s(t) the quartic polynomial over the distance S between the nodes. The duration of
/// an edge of the length S is T = 2 S/(b + sqrt(b^2 + a_0 S/3)) with b = (v_0 + v_1)/2, the speed
/// v_0 and acceleration a_0 at the edge's start, and the speed v_1 at the edge's end. The cost of a
/// path through the lattice is the sum of the costs C of its edges.
namespace trackbed {

/// Plans the cheapest drivable path to the last layer of the lattice. With the goal StopAt, the
/// last layer has speed 0 and lies at the goal's station, if this station is within the lattice;
/// the other layers are then closer together. With the goal FollowLeader, every node on the path
/// adds the cost K_s (s - S_1)^2, with the weight K_s, the node's station s and the desired station
/// S_1 when the car arrives at the node.
///
/// Guarantees: the guarantees of PlanFrenet also hold for PlanLattice, with edges in place of
/// candidates. Every edge of the resulting path is checked against the obstacles at the time at
/// which the car drives the edge. With one layer, the resulting motion is the cheapest of
/// PlanFrenet's candidates with the same end states and durations. With more than one layer, the
/// resulting motion costs at most as much as the cheapest single edge to the last layer. If no
/// obstacle moves, the resulting motion is optimal among all paths through the lattice. With moving
/// obstacles, the resulting motion is optimal among the paths on which the part up to each node is
/// the cheapest path to this node. Throws the same exceptions as PlanFrenet. Computing time: 3 ms
/// with the default options. The planner computes the costs of O((layers x offsets x speeds)^2)
/// edges, and checks edges in order of cost.
FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options);

}  // namespace trackbed
