// Chooses the corners of a polyline whose waypoints are close to each other.
//
// The corners are a shortest path through the graph of legs. A node is a leg between two points of
// the polyline, and an edge is the corner between two legs. The cost of an edge counts, in this
// order, corners that do not fit on their legs, points left out, and distances of the points left
// out.
#include "trackbed/planning/common/fewer_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxLeftOut = 50;
/// Largest heading change that counts as straight [rad].
constexpr double kStraightOn = 1e-9;

double TurnAt(const Vec2& from, const Vec2& at, const Vec2& to) {
  const Vec2 in = at - from;
  const Vec2 out = to - at;
  return std::abs(std::atan2(Cross(in, out), in.dot(out)));
}

double DistanceFromLeg(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from;
  const double share = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - share * along).norm();
}

/// Tangent lengths and gaps of corners at the lowest speed, tabulated by heading change. The table
/// is densest at small heading changes: a tangent length grows with the square root of the heading
/// change.
class SlowCorners {
 public:
  SlowCorners(const VehicleParams& vehicle, const CornerLimits& limits) {
    for (std::size_t i = 1; i < kCount; ++i) {
      const double share = static_cast<double>(i) / kCount;
      const RoundCorner corner =
          CornerAt(vehicle, kPi * share * share, limits.min_speed, limits.max_curvature);
      entries_[i] = {corner.tangent_length, corner.gap};
    }
    entries_.back() = {kInfinity, kInfinity};
  }

  /// Returns the entry of the next larger heading change, which needs at least as much room.
  [[nodiscard]] const CornerRoom& operator()(double turn) const {
    const double place = std::ceil(std::sqrt(turn / kPi) * kCount);
    return turn <= kStraightOn ? entries_.front()
                               : entries_[std::min(static_cast<std::size_t>(place), kCount)];
  }

 private:
  static constexpr std::size_t kCount = 300;
  std::array<CornerRoom, kCount + 1> entries_{};
};

/// Cost of a polyline up to a leg; costs are compared lexicographically, from the first member to
/// the last.
struct Cost {
  std::size_t tight = 0;     // Number of corners that do not fit on their legs.
  std::size_t left_out = 0;  // Number of polyline points left out.
  double distance = 0.0;     // Sum of the left-out points' distances to the path [m].

  bool operator<(const Cost& other) const {
    return std::tie(tight, left_out, distance) <
           std::tie(other.tight, other.left_out, other.distance);
  }
};

/// The cheapest polyline up to the end of a leg.
struct Leg {
  bool exists = false;
  Cost cost;               // Cost of the whole polyline.
  std::size_t before = 0;  // Index of the point at which the previous leg begins.
};

class CornerChoice {
 public:
  CornerChoice(const std::vector<Vec2>& points, const WaypointChoice& limits)
      : points_(points), limits_(limits), is_waypoint_(points.size()) {
    constexpr double kAtWaypoint = 1e-6;  // [m]
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      is_waypoint_[i] =
          std::any_of(limits.waypoints.begin() + 1, limits.waypoints.end(),
                      [&](const Vec2& at) { return (at - points[i]).norm() < kAtWaypoint; });
    }
  }

  [[nodiscard]] std::vector<Vec2> Run() {
    const std::size_t n = points_.size();
    legs_.resize(n);
    for (std::size_t to = 1; to < n; ++to) {
      const std::size_t first = to > kMaxLeftOut + 1 ? to - kMaxLeftOut - 1 : 0;
      legs_[to].resize(to - first);
      for (std::size_t from = first; from < to; ++from) {
        legs_[to][to - from - 1] = CheapestLeg(from, to);
      }
    }
    return Trace();
  }

 private:
  [[nodiscard]] const Leg& LegBetween(std::size_t from, std::size_t to) const {
    static const Leg none;
    const std::size_t index = to - from - 1;
    return index < legs_[to].size() ? legs_[to][index] : none;
  }

  /// Returns the cost of leaving out the points between two points; nullopt if the path must keep a
  /// point between them.
  [[nodiscard]] std::optional<Cost> LeftOut(std::size_t from, std::size_t to) const {
    Cost cost;
    if (points_[from] == points_[to] ||
        (from == 0 && limits_.keeps_first_direction && !KeepsDirection(to))) {
      return std::nullopt;
    }
    for (std::size_t i = from + 1; i < to; ++i) {
      // A path that keeps the first leg passes all points on the first leg.
      const double distance =
          std::min(DistanceFromLeg(points_[i], points_[from], points_[to]),
                   is_waypoint_[i] || from > 0 ? DistanceFromLeg(points_[i], points_[0], points_[1])
                                               : kInfinity);
      constexpr double kOnLeg = 1e-9;  // [m]
      if (distance > (is_waypoint_[i] ? limits_.max_gap : kOnLeg)) {
        return std::nullopt;
      }
      cost.left_out += distance > kOnLeg ? 1 : 0;
      cost.distance += distance;
    }
    return cost;
  }

  [[nodiscard]] bool KeepsDirection(std::size_t to) const {
    const Vec2 first = points_[1] - points_[0];
    const Vec2 leg = points_[to] - points_[0];
    return std::abs(std::atan2(Cross(first, leg), first.dot(leg))) <= kStraightOn;
  }

  [[nodiscard]] bool Fits(std::size_t from, std::size_t at, std::size_t to) const {
    const double room = std::min(
        (points_[at] - points_[from]).norm() * (from == 0 ? limits_.end_share : 0.5),
        (points_[to] - points_[at]).norm() * (to + 1 == points_.size() ? limits_.end_share : 0.5));
    const CornerRoom corner = limits_.room(TurnAt(points_[from], points_[at], points_[to]));
    return corner.tangent <= room && (!is_waypoint_[at] || corner.gap <= limits_.max_gap);
  }

  /// Whether the turn from the car's heading to the first leg fits on half of this leg.
  [[nodiscard]] bool FitsAtStart(std::size_t to) const {
    if (!limits_.start_yaw) {
      return true;
    }
    const Vec2 leg = points_[to] - points_[0];
    const double turn = std::abs(WrapAngle(std::atan2(leg.y(), leg.x()) - *limits_.start_yaw));
    return limits_.room(turn).tangent <= 0.5 * leg.norm();
  }

  [[nodiscard]] Leg CheapestLeg(std::size_t from, std::size_t to) const {
    const std::optional<Cost> own = LeftOut(from, to);
    if (!own) {
      return {};
    }
    Leg best{.exists = from == 0, .cost = *own};
    if (from == 0 && !FitsAtStart(to)) {
      best.cost.tight += 1;
    }
    for (std::size_t before = from; before-- > 0;) {
      const Leg& leg = LegBetween(before, from);
      if (!leg.exists) {
        continue;
      }
      const Cost cost{leg.cost.tight + (Fits(before, from, to) ? 0 : 1),
                      leg.cost.left_out + own->left_out, leg.cost.distance + own->distance};
      if (!best.exists || cost < best.cost) {
        best = {true, cost, before};
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<Vec2> Trace() const {
    std::size_t to = points_.size() - 1;
    std::size_t from = to - 1;
    for (std::size_t other = from; other-- > 0;) {
      if (LegBetween(other, to).exists &&
          (!LegBetween(from, to).exists ||
           LegBetween(other, to).cost < LegBetween(from, to).cost)) {
        from = other;
      }
    }
    std::vector<Vec2> kept{points_[to]};
    while (to != 0) {
      kept.push_back(points_[from]);
      const std::size_t before = LegBetween(from, to).before;
      to = from;
      from = before;
    }
    std::reverse(kept.begin(), kept.end());
    return kept;
  }

  const std::vector<Vec2>& points_;
  const WaypointChoice& limits_;
  std::vector<bool> is_waypoint_;
  std::vector<std::vector<Leg>>
      legs_;  // All legs, by the leg's end point, then by the number of points between its ends.
};

}  // namespace

std::vector<Vec2> LeaveOutCloseWaypoints(const std::vector<Vec2>& polyline,
                                         const WaypointChoice& choice) {
  return polyline.size() < 3 || choice.waypoints.size() < 2 ? polyline
                                                            : CornerChoice(polyline, choice).Run();
}

std::vector<Vec2> LeaveOutCloseWaypoints(const VehicleParams& vehicle,
                                         const std::vector<Vec2>& polyline,
                                         const CornerLimits& limits) {
  const SlowCorners corners(vehicle, limits);
  return LeaveOutCloseWaypoints(
      polyline,
      {limits.waypoints, limits.max_gap, [&](double turn) -> CornerRoom { return corners(turn); }});
}

}  // namespace trackbed
