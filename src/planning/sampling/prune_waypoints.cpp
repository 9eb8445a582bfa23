#include "src/planning/sampling/prune_waypoints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/geometry/box_index.h"

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Cost assigned to a corner that the car cannot drive [m].
constexpr double kTooTight = 1e6;
/// Largest number of corners that a new corner replaces.
constexpr std::size_t kSpan = 8;

/// Returns the cost of the corner at the waypoint `at`. With `all_in`, the corner may use the whole
/// incoming leg instead of half of it; `all_out` does the same for the outgoing leg.
double CornerCost(const PruningProblem& problem, const Vec2& from, const Vec2& at, const Vec2& to,
                  bool all_in, bool all_out) {
  const Vec2 in = at - from;
  const Vec2 out = to - at;
  const double room =
      std::min(in.norm() * (all_in ? 1.0 : 0.5), out.norm() * (all_out ? 1.0 : 0.5));
  const double turn = std::abs(std::atan2(Cross(in, out), in.dot(out)));
  return problem.tangent(turn) > room ? kTooTight : 0.0;
}

/// Cheapest path whose last line connects two given points.
struct Line {
  double cost = kInfinity;
  /// Index of the waypoint at which the second-to-last line of the path begins.
  std::size_t before = 0;
};

/// Finds the cheapest path through a subset of the n points of `way` (PruneWaypoints), in O(n^3).
/// `is_free` returns for two indices of points whether the straight line between the points is
/// free.
template <typename IsFree>
std::vector<Vec2> PruneWindow(const std::vector<Vec2>& way, const PruningProblem& problem,
                              const IsFree& is_free) {
  const std::size_t n = way.size();
  const bool windy = problem.wind.weight != 0.0 && !IsCalm(problem.wind.wind);
  std::vector<Line> lines(n * n);
  for (std::size_t i = 1; i < n; ++i) {
    const bool ends = problem.last_leg && i + 1 == n;
    for (std::size_t k = 0; k < i; ++k) {
      if (!is_free(k, i)) {
        continue;
      }
      Line best;
      if (k == 0) {
        best.cost = problem.before ? CornerCost(problem, *problem.before, way[0], way[i],
                                                problem.first_leg, ends)
                                   : 0.0;
      }
      for (std::size_t j = 0; j < k; ++j) {
        const double so_far = lines[j * n + k].cost;
        if (so_far < best.cost) {
          const bool begins = problem.first_leg && !problem.before && j == 0;
          const double cost = so_far + CornerCost(problem, way[j], way[k], way[i], begins, ends);
          if (cost < best.cost) {
            best = {cost, j};
          }
        }
      }
      best.cost += problem.corner_cost + (way[i] - way[k]).norm();
      if (windy) {
        best.cost -= WindScore(InPieces({way[k], way[i]}), problem.wind);
      }
      lines[k * n + i] = best;
    }
  }
  std::size_t to = n - 1;
  std::size_t from = 0;
  for (std::size_t k = 0; k < to; ++k) {
    from = lines[k * n + to].cost < lines[from * n + to].cost ? k : from;
  }
  std::vector<Vec2> few{way[to]};
  while (to != 0) {
    few.push_back(way[from]);
    const std::size_t before = lines[from * n + to].before;
    to = from;
    from = before;
  }
  std::reverse(few.begin(), few.end());
  return few;
}

/// Returns whether every corner of a path fits on its lines.
bool CornersFit(const std::vector<Vec2>& way, const PruningProblem& problem) {
  for (std::size_t i = problem.before ? 0 : 1; i + 1 < way.size(); ++i) {
    const bool begins = problem.first_leg && i == (problem.before ? 0 : 1);
    const bool ends = problem.last_leg && i + 2 == way.size();
    const Vec2& from = i == 0 ? *problem.before : way[i - 1];
    if (CornerCost(problem, from, way[i], way[i + 1], begins, ends) > 0.0) {
      return false;
    }
  }
  return true;
}

/// A corner that may replace some successive points of a path.
struct OuterCorner {
  Vec2 at;
  /// Index of the corner among the points of the path; nullopt for a new corner.
  std::optional<std::size_t> point{};
};

/// Returns the point at which two lines meet if both are extended toward each other. The first line
/// is extended from `a` through `b` beyond `b`, and the second one from `d` through `c` beyond `c`.
std::optional<Vec2> Meeting(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 in = b - a;
  const Vec2 out = d - c;
  const double area = Cross(in, out);
  const double ahead =
      Cross(c - b, out) /
      area;  // Distance of the corner beyond `b`, divided by the first line's length.
  const double behind =
      Cross(c - b, in) /
      area;  // Position of the corner after `c`, divided by the second line's length.
  if (!std::isfinite(ahead) || !std::isfinite(behind) || ahead < 0.0 || behind > 0.0) {
    return std::nullopt;
  }
  return Vec2(b + ahead * in);
}

/// Returns the points of a path, and the corners at which two of its lines meet if both are
/// extended. Between the two lines of a corner are at least one and fewer than kSpan other lines.
/// The corners are sorted in the order of the path.
std::vector<OuterCorner> WithOuterCorners(const std::vector<Vec2>& way) {
  std::vector<OuterCorner> corners{{way.front(), 0}};
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    corners.push_back({way[i + 1], i + 1});
    for (std::size_t j = i + 2; j + 1 < way.size() && j <= i + kSpan; ++j) {
      if (const auto meeting = Meeting(way[i], way[i + 1], way[j], way[j + 1])) {
        corners.push_back({*meeting});
      }
    }
  }
  return corners;
}

}  // namespace

std::vector<Vec2> JoinCloseCorners(const std::vector<Vec2>& way, const PruningProblem& problem) {
  if (way.size() < 4 || way.size() > kJoinedPoints || CornersFit(way, problem)) {
    return way;
  }
  const std::vector<OuterCorner> corners = WithOuterCorners(way);
  std::vector<Vec2> points;
  for (const OuterCorner& corner : corners) {
    points.push_back(corner.at);
  }
  const BoxIndex obstacles(problem.obstacles);
  return PruneWindow(points, problem, [&](std::size_t k, std::size_t i) {
    const bool is_given =
        corners[k].point && corners[i].point && *corners[i].point == *corners[k].point + 1;
    return is_given || obstacles.KeepsFrom(points[k], points[i], problem.inflation);
  });
}

std::vector<Vec2> PruneWaypoints(const std::vector<Vec2>& way, const PruningProblem& problem) {
  const BoxIndex obstacles(problem.obstacles);
  std::vector<Vec2> few{way.front()};
  for (std::size_t begin = 0; begin + 1 < way.size();) {
    const std::size_t end = std::min(begin + kPruningWindow, way.size() - 1);
    const auto at = [&](std::size_t i) { return way.begin() + static_cast<std::ptrdiff_t>(i); };
    PruningProblem own = problem;
    if (few.size() > 1) {
      own.before = few[few.size() - 2];
      own.first_leg = problem.first_leg && !problem.before && few.size() == 2;
    }
    own.last_leg = problem.last_leg && end + 1 == way.size();
    const std::vector<Vec2> pruned =
        PruneWindow({at(begin), at(end) + 1}, own, [&](std::size_t k, std::size_t i) {
          return k + 1 == i ||
                 obstacles.KeepsFrom(way[begin + k], way[begin + i], problem.inflation);
        });
    few.insert(few.end(), pruned.begin() + 1, pruned.end());
    begin = end;
  }
  return few;
}

std::vector<Vec2> InPieces(const std::vector<Vec2>& way) {
  constexpr double kPiece = 1.0;  // [m]
  std::vector<Vec2> pieces{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec2 along = way[i] - way[i - 1];
    const double count = std::max(std::ceil(along.norm() / kPiece), 1.0);
    for (double k = 1.0; k < count; k += 1.0) {
      pieces.emplace_back(way[i - 1] + along * (k / count));
    }
    pieces.push_back(way[i]);
  }
  return pieces;
}

}  // namespace trackbed
