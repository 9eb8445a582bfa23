#include "trackbed/planning/sampling/comparator.h"

#include <algorithm>

#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"

namespace trackbed {
namespace {

/// Returns the remaining path of a car at `position`: the part of the path after the point nearest
/// to the car.
std::vector<Vec2> Rest(const std::vector<Vec2>& way, const Vec2& position) {
  std::size_t next = way.size();
  Vec2 nearest = way.back();
  double distance = (position - nearest).norm();
  // Search backward from the end, so that the later of two equally near points is found; the car
  // has already driven the part before this point.
  for (std::size_t i = way.size() - 1; i > 0; --i) {
    const Vec2 along = way[i] - way[i - 1];
    const double square = along.squaredNorm();
    const double share =
        square > 0.0 ? std::clamp((position - way[i - 1]).dot(along) / square, 0.0, 1.0) : 0.0;
    const Vec2 foot = way[i - 1] + share * along;
    if ((position - foot).norm() < distance) {
      distance = (position - foot).norm();
      nearest = foot;
      next = i;
    }
  }
  std::vector<Vec2> rest{nearest};
  rest.insert(rest.end(), way.begin() + static_cast<std::ptrdiff_t>(next), way.end());
  return rest;
}

}  // namespace

PathScore ScorePath(const std::vector<Vec2>& way, const Vec2& position,
                    const std::vector<OrientedBox>& obstacles, const Inflation& inflation,
                    const WindScoring& wind, const ComparatorOptions& options) {
  TRACKBED_CHECK(!way.empty() && options.collision_penalty >= 0.0 && inflation.most >= 0.0,
                 "a path of {} points, penalty {}, inflation {}", way.size(),
                 options.collision_penalty, inflation.most);
  const std::vector<Vec2> rest = Rest(way, position);
  PathScore score;
  score.length = (position - rest.front()).norm();
  for (std::size_t i = 1; i < rest.size(); ++i) {
    score.length += (rest[i] - rest[i - 1]).norm();
  }
  const BoxIndex index(obstacles);
  for (std::size_t i = 0; i < rest.size() && !score.collides; ++i) {
    const Vec2& from = rest[i == 0 ? 0 : i - 1];
    score.collides = !index.KeepsFrom(from, rest[i], inflation);
  }
  score.wind = WindScore(rest, wind);
  score.total = score.length - score.wind + (score.collides ? options.collision_penalty : 0.0);
  return score;
}

void Visit(DiagnosticsVisitor& out, const PathScore& score) {
  out.Number("length_m", score.length);
  out.Number("wind_m", score.wind);
  out.Flag("collides", score.collides);
  out.Number("total_m", score.total);
}

}  // namespace trackbed
