#include "trackbed/planning/common/waypoint_miss.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace trackbed {
namespace {

/// Projects points onto a whole path. The nodes of a binary tree halve the segments of the path. No
/// point of a node is farther from the node's middle than half of the node's length, so most nodes
/// are skipped. For a point near the path, the cost is about the logarithm of the number of
/// segments.
class TreeProjection {
 public:
  explicit TreeProjection(const Path& path) : path_(path) {
    double station = 0.0;
    for (const Segment& segment : path.segments()) {
      station += segment.length;
      stations_.push_back(station);
    }
    Add(0, path.segments().size());
  }

  /// Returns the station of the path's point that is nearest to `at`; the smallest of these
  /// stations if several points are equally near.
  [[nodiscard]] WaypointMiss Nearest(const Vec2& at) const {
    WaypointMiss nearest{.at = at, .distance = std::numeric_limits<double>::infinity()};
    Search(0, at, nearest);
    return nearest;
  }

 private:
  struct Node {
    Stations within;
    Vec2 middle = Vec2::Zero();
    std::size_t second = 0;  // Index of the second child; the first child follows its parent.
  };

  /// Adds a node with the segments from `first` up to `last`, and all nodes below this node.
  void Add(std::size_t first, std::size_t last) {
    constexpr std::size_t kSegmentsOfLeaf = 4;
    const Stations within{stations_[first], stations_[last]};
    const std::size_t node = nodes_.size();
    nodes_.push_back({within, path_.At(0.5 * (within.from + within.to)).pose.position()});
    if (last - first > kSegmentsOfLeaf) {
      const std::size_t half = first + (last - first) / 2;
      Add(first, half);
      nodes_[node].second = nodes_.size();
      Add(half, last);
    }
  }

  /// Replaces `nearest` by a nearer point of a node.
  void Search(std::size_t node, const Vec2& at, WaypointMiss& nearest) const {
    const Node& own = nodes_[node];
    if (LeastDistance(own, at) > nearest.distance) {
      return;
    }
    if (own.second > 0) {
      std::array<std::size_t, 2> children{node + 1, own.second};
      if (LeastDistance(nodes_[children[1]], at) < LeastDistance(nodes_[children[0]], at)) {
        std::swap(children[0], children[1]);
      }
      for (const std::size_t child : children) {
        Search(child, at, nearest);
      }
      return;
    }
    const double s = path_.Project({at.x(), at.y(), 0.0}, own.within).s;
    const double distance = (path_.At(s).pose.position() - at).norm();
    if (distance < nearest.distance || (distance == nearest.distance && s < nearest.station)) {
      nearest.distance = distance;
      nearest.station = s;
    }
  }

  /// Returns a lower bound of the distance between a node and a point [m].
  static double LeastDistance(const Node& node, const Vec2& at) {
    return (node.middle - at).norm() - 0.5 * (node.within.to - node.within.from);
  }

  const Path& path_;
  std::vector<double> stations_{0.0};  // Stations of the ends of the segments [m].
  std::vector<Node> nodes_;
};

}  // namespace

std::optional<WaypointMiss> LargestWaypointMiss(const Path& path,
                                                const std::vector<Vec2>& waypoints) {
  std::optional<WaypointMiss> largest;
  const TreeProjection projection(path);
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    WaypointMiss miss = projection.Nearest(waypoints[i]);
    if (!largest || miss.distance > largest->distance + kSameMiss) {
      miss.waypoint = i;
      largest = miss;
    }
  }
  return largest;
}

std::string DescribeWaypoint(std::size_t waypoint, const Vec2& at) {
  return fmt::format("waypoint {} at ({:.10g}, {:.10g})", waypoint, at.x(), at.y());
}

std::string RemedyForMiss(double distance) {
  // Unit of the last digit if the distance is written with three digits; at least a millimeter.
  const double digit = std::pow(10.0, std::max(std::floor(std::log10(distance)) - 2.0, -3.0));
  return fmt::format("set plan.max_waypoint_miss to at least {:.10g}, or move the waypoint",
                     digit * (std::floor(distance / digit) + 1.0));
}

}  // namespace trackbed
