#include "trackbed/planning/frenet/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "src/planning/frenet/frenet_pieces.h"
#include "src/planning/frenet/trajectory_check.h"
#include "trackbed/core/error.h"

// Plans motions through a lattice of stations, offsets and speeds (the third variant of the Frenet
// lecture). Label finds the cheapest path to each node by dynamic programming: layer by layer, it
// considers all edges from earlier nodes. Label performs a coarse feasibility check of the edges,
// in order of cost. Finish performs the full feasibility check of the cheapest path to the last
// layer. If an edge of the cheapest path fails, Finish bans the edge, and labeling resumes at the
// layer of the edge.

namespace trackbed {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Distance from the stopping place within which the car counts as arrived [m].
constexpr double kArrived = 0.05;

/// A node of the lattice, with the cheapest known path from the start to the node.
struct Node {
  FrenetState state;
  // Target of the edges that end at this node. If the car follows a leader, the station of the
  // target depends on the edge.
  FrenetTarget target;
  double cost = kInfinite;
  double time = 0.0;
  std::size_t from = 0;
  FrenetPiece piece;  // Piece of motion from the node `from` to this node.
  int edges = 0;      // Number of edges that end at this node.
};

struct Edge {
  double cost;  // Cost of the whole path from the start over this edge.
  std::size_t from;
  FrenetPiece piece;
};

class Lattice {
 public:
  Lattice(const Path& reference, const FrenetRequest& request, const LatticeOptions& options)
      : reference_(reference), request_(request), options_(options) {
    Node& start = nodes_.emplace_back();
    start.state = request.start;
    start.cost = 0.0;
    layers_.push_back(0);
    BuildLayers();
    layers_.push_back(nodes_.size());
  }

  FrenetPlan Search() {
    const double to = nodes_.back().state.s;
    const TrajectoryCheck check(reference_, request_, options_.limits, to);
    if (check.blocked()) {
      plan_.status = PlanStatus::kStartBlocked;
      plan_.reason = *check.blocked();
      return plan_;
    }
    // If an edge that passed the coarse check fails the fine check, search again without this edge.
    std::size_t layer = 1;
    while (!plan_.ok() && Label(check, layer)) {
      layer = Finish(check);
    }
    for (const Node& node : nodes_) {
      plan_.candidates += node.edges;
    }
    if (!plan_.ok()) {
      plan_.reason = ExplainFailure(plan_, "edges", options_.budget);
    }
    return plan_;
  }

 private:
  /// Creates the nodes of the lattice, layer by layer.
  void BuildLayers() {
    const double from = request_.start.s;
    const auto* stop = std::get_if<StopAt>(&request_.goal);
    double spacing = options_.spacing;
    int layers = options_.layers;
    bool stops = false;
    if (stop != nullptr && stop->station - from <= layers * spacing) {
      const double way = stop->station - from;
      layers = way > kArrived ? static_cast<int>(std::ceil(way / spacing)) : 0;
      spacing = way / std::max(layers, 1);
      stops = true;
    }
    const double speed = stop != nullptr ? request_.speed.speed
                                         : TargetAt(request_.goal, request_.vehicle, 0.0).speed;
    for (int layer = 1; layer <= layers; ++layer) {
      layers_.push_back(nodes_.size());
      const bool rests = stops && layer == layers;
      for (const double offset : options_.end_offsets) {
        if (rests) {
          AddNode(from + layer * spacing, offset, 0.0, 0.0);
          continue;
        }
        for (const double factor : options_.speed_factors) {
          AddNode(from + layer * spacing, offset, factor * speed, speed);
        }
      }
    }
  }

  void AddNode(double station, double offset, double speed, double wanted_speed) {
    Node& node = nodes_.emplace_back();
    node.state = {station, speed, 0.0, offset, 0.0, 0.0};
    node.target.speed = wanted_speed;
  }

  /// Returns the motion between two nodes; nullopt if the car would stand still or move backward.
  [[nodiscard]] std::optional<FrenetPiece> Between(const FrenetState& from,
                                                   const FrenetState& to) const {
    const double way = to.s - from.s;
    const double mean = 0.5 * (from.s_rate + to.s_rate);
    const double root = mean * mean + from.s_acceleration * way / 3.0;
    const double duration = 2.0 * way / (mean + std::sqrt(root));
    if (!(root >= 0.0) || !(duration > 0.0) || !std::isfinite(duration)) {
      return std::nullopt;
    }
    FrenetPiece piece{
        duration, QuarticBetween(LongitudinalMotion(from), LongitudinalMotion(to), duration), {}};
    AddOverStation(from, to.d, piece);
    return piece;
  }

  /// Collects all edges to a node from earlier nodes with a known path. Ranks the edges by the cost
  /// of the whole path.
  void EdgesTo(const Node& node, std::size_t before) {
    edges_.clear();
    for (std::size_t i = 0; i < before; ++i) {
      if (nodes_[i].cost == kInfinite) {
        continue;
      }
      const auto piece = Between(nodes_[i].state, node.state);
      if (!piece) {
        continue;
      }
      FrenetTarget target = node.target;
      if (std::holds_alternative<FollowLeader>(request_.goal)) {
        target = TargetAt(request_.goal, request_.vehicle, nodes_[i].time + piece->duration);
      }
      const double cost = nodes_[i].cost + PieceCost(*piece, target, options_.weights).total;
      edges_.push_back({cost, i, *piece});
    }
    ranks_.resize(edges_.size());
    std::iota(ranks_.begin(), ranks_.end(), std::size_t{0});
    std::sort(ranks_.begin(), ranks_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(edges_[a].cost, a) < std::pair(edges_[b].cost, b);
    });
  }

  /// Finds the cheapest path to every node from `layer` on. Returns whether a path reaches the last
  /// layer.
  bool Label(const TrajectoryCheck& check, std::size_t layer) {
    for (; layer + 1 < layers_.size(); ++layer) {
      for (std::size_t to = layers_[layer]; to < layers_[layer + 1]; ++to) {
        Node& node = nodes_[to];
        node.cost = kInfinite;
        EdgesTo(node, layers_[layer]);
        node.edges = static_cast<int>(edges_.size());
        for (const std::size_t rank : ranks_) {
          const Edge& edge = edges_[rank];
          if (banned_.contains({edge.from, to})) {
            continue;
          }
          if (plan_.checked >= options_.budget) {
            return false;
          }
          ++plan_.checked;
          const double time = nodes_[edge.from].time;
          if (const auto rejection = check.CheckCoarsely(edge.piece, time)) {
            plan_.rejected.Add(*rejection);
            continue;
          }
          ++plan_.passed;
          node.cost = edge.cost;
          node.time = time + edge.piece.duration;
          node.from = edge.from;
          node.piece = edge.piece;
          break;
        }
      }
    }
    return layers_.size() > 2 && std::any_of(nodes_.begin() + Last(), nodes_.end(),
                                             [](const Node& n) { return n.cost < kInfinite; });
  }

  [[nodiscard]] std::ptrdiff_t Last() const {
    return static_cast<std::ptrdiff_t>(layers_[layers_.size() - 2]);
  }

  /// Checks the cheapest path of the lattice against all limits. If the path passes the check,
  /// stores it as the result; otherwise bans the failed edge and returns the layer in which this
  /// edge ends.
  std::size_t Finish(const TrajectoryCheck& check) {
    const auto end = std::min_element(nodes_.begin() + Last(), nodes_.end(),
                                      [](const Node& a, const Node& b) { return a.cost < b.cost; });
    std::vector<std::size_t> way;
    for (auto at = static_cast<std::size_t>(end - nodes_.begin()); at != 0; at = nodes_[at].from) {
      way.insert(way.begin(), at);
    }
    FrenetMotion motion;
    for (const std::size_t at : way) {
      motion.pieces.push_back(nodes_[at].piece);
    }
    auto points =
        SampleMotion(reference_, motion, options_.limits.time_step, options_.limits.spacing);
    const auto flaw = points ? check.CheckFinely(*points)
                             : TrajectoryCheck::Flaw{Rejection::kFrame, motion.duration()};
    if (flaw) {
      --plan_.passed;
      plan_.rejected.Add(flaw->rejection);
      const auto at = std::find_if(way.begin(), way.end() - 1, [&](std::size_t node) {
        return flaw->time <= nodes_[node].time;
      });
      banned_.insert({nodes_[*at].from, *at});
      const auto after = std::upper_bound(layers_.begin(), layers_.end(), *at);
      return static_cast<std::size_t>(after - layers_.begin()) - 1;
    }
    plan_.status = PlanStatus::kOk;
    plan_.motion = std::move(motion);
    plan_.points = std::move(*points);
    plan_.cost = end->cost;
    return layers_.size();
  }

  const Path& reference_;
  const FrenetRequest& request_;
  const LatticeOptions& options_;
  // All nodes of the lattice: first the start, then the nodes of each layer.
  std::vector<Node> nodes_;
  // Index of each layer's first node, followed by the number of nodes.
  std::vector<std::size_t> layers_;
  std::vector<Edge> edges_;  // Edges that end at the node being labeled.
  // Indices of the edges that end at the node, the cheapest edge first.
  std::vector<std::size_t> ranks_;
  std::set<std::pair<std::size_t, std::size_t>> banned_;
  FrenetPlan plan_;
};

}  // namespace

FrenetPlan PlanLattice(const Path& reference, const FrenetRequest& request,
                       const LatticeOptions& options) {
  CheckRequest(request, options.limits, options.weights);
  TRACKBED_CHECK(options.layers >= 0 && options.spacing > 0.0, "{} layers {} m apart",
                 options.layers, options.spacing);
  return Lattice(reference, request, options).Search();
}

}  // namespace trackbed
