#include "trackbed/planning/sampling/smoothing.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"
#include "trackbed/geometry/box_index.h"

namespace trackbed {
namespace {

/// Score difference up to which two scores count as equal [m]; in a uniform wind, the scores of all
/// paths are equal up to rounding errors.
constexpr double kEqualityTolerance = 1e-9;

/// Returns the wind score of one straight line.
double SegmentScore(const Vec2& from, const Vec2& to, const WindScoring& scoring) {
  const Vec2 wind = WindAt(scoring.wind, 0.5 * (from + to), scoring.time);
  return scoring.weight * wind.dot(to - from) / scoring.speed;
}

class Smoother {
 public:
  Smoother(const std::vector<Vec2>& path, const std::vector<OrientedBox>& obstacles,
           const Inflation& inflation, const WindScoring& wind, const SmoothingOptions& options)
      : original_(path),
        smooth_(path),
        obstacles_(obstacles),
        inflation_(inflation),
        wind_(wind),
        options_(options),
        windless_(wind.weight == 0.0 || IsCalm(wind.wind)) {}

  SmoothingResult Run() {
    SmoothingResult result;
    while (!result.converged && result.sweeps < options_.sweeps) {
      ++result.sweeps;
      double change = 0.0;
      for (std::size_t i = 1; i + 1 < smooth_.size(); ++i) {
        change += Move(i, 0) + Move(i, 1);
      }
      result.converged = change < options_.tolerance;
    }
    result.path = smooth_;
    return result;
  }

 private:
  /// Moves one coordinate of a point by one smoothing step and returns the distance of the move.
  double Move(std::size_t i, Eigen::Index coordinate) {
    const Vec2& before = smooth_[i - 1];
    const Vec2& after = smooth_[i + 1];
    const double old = smooth_[i][coordinate];
    Vec2 moved = smooth_[i];
    moved[coordinate] += options_.data * (original_[i][coordinate] - old) +
                         options_.smoothness * (before[coordinate] + after[coordinate] - 2.0 * old);
    if (moved[coordinate] == old || !IsFree(before, moved) || !IsFree(moved, after) ||
        (!windless_ &&
         Score(before, moved, after) < Score(before, smooth_[i], after) - kEqualityTolerance)) {
      return 0.0;
    }
    smooth_[i] = moved;
    return std::abs(moved[coordinate] - old);
  }

  [[nodiscard]] bool IsFree(const Vec2& from, const Vec2& to) const {
    return obstacles_.KeepsFrom(from, to, inflation_);
  }

  [[nodiscard]] double Score(const Vec2& before, const Vec2& at, const Vec2& after) const {
    return SegmentScore(before, at, wind_) + SegmentScore(at, after, wind_);
  }

  const std::vector<Vec2>& original_;
  std::vector<Vec2> smooth_;
  BoxIndex obstacles_;
  const Inflation& inflation_;
  const WindScoring& wind_;
  const SmoothingOptions& options_;
  bool windless_;
};

void CheckSpeed(const WindScoring& scoring) {
  TRACKBED_CHECK(scoring.speed > 0.0 && std::isfinite(scoring.weight), "speed {}, weight {}",
                 scoring.speed, scoring.weight);
}

}  // namespace

double WindScore(const std::vector<Vec2>& path, const WindScoring& scoring) {
  CheckSpeed(scoring);
  double score = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    score += SegmentScore(path[i - 1], path[i], scoring);
  }
  return score;
}

SmoothingResult SmoothPath(const std::vector<Vec2>& path, const std::vector<OrientedBox>& obstacles,
                           const Inflation& inflation, const WindScoring& wind,
                           const SmoothingOptions& options) {
  CheckSpeed(wind);
  const double step = options.data + 2.0 * options.smoothness;
  TRACKBED_CHECK(options.data >= 0.0 && options.smoothness >= 0.0 && step > 0.0 && step < 1.0 &&
                     options.tolerance > 0.0 && options.sweeps >= 0 && inflation.most >= 0.0,
                 "data {}, smoothness {}, tolerance {}, sweeps {}, inflation {}", options.data,
                 options.smoothness, options.tolerance, options.sweeps, inflation.most);
  return Smoother(path, obstacles, inflation, wind, options).Run();
}

}  // namespace trackbed
