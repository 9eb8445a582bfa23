#include "src/planning/common/jerk_limit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace trackbed {
namespace {

/// The function G of LimitJerk, with G'' = K = 2 jerk/v, at each station, and the slopes of G
/// before and after the station.
struct Bound {
  std::vector<double> value;
  std::vector<double> left;
  std::vector<double> right;
};

/// Integrates the equation G'' = K = 2 jerk/v. At each station, the slope rises by 2 jerk/v times
/// half the length of the two adjacent intervals. The speed v is the largest of the speeds at the
/// station and at its two neighbors, so that the second differences satisfy the limit exactly.
Bound Integrate(const std::vector<double>& stations, double jerk,
                const std::vector<double>& squares) {
  const std::size_t count = stations.size();
  Bound bound{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0;
    const std::size_t after = std::min(i + 1, count - 1);
    const double fastest = std::max({squares[before], squares[i], squares[after]});
    // If the car's speed is 0 at all three stations, use a small positive speed to avoid a division
    // by zero.
    const double speed = std::sqrt(std::max(fastest, 1e-12));
    const double length = (stations[after] - stations[before]) * (after - before == 1 ? 2.0 : 1.0);
    if (i > 0) {
      bound.left[i] = bound.right[before];
      bound.value[i] = bound.value[before] + bound.left[i] * (stations[i] - stations[before]);
    }
    bound.right[i] = bound.left[i] + jerk * length / speed;
  }
  return bound;
}

/// Replaces the squared speeds by w1, the result of step 1 of LimitJerk.
void LowerValleys(const std::vector<double>& stations, const Bound& bound,
                  std::vector<double>& squares) {
  const std::vector<double> given = squares;
  const std::size_t count = stations.size();
  for (std::size_t t = 1; t + 1 < count; ++t) {
    const double before = (given[t] - given[t - 1]) / (stations[t] - stations[t - 1]);
    const double after = (given[t + 1] - given[t]) / (stations[t + 1] - stations[t]);
    if (after - before <= bound.right[t] - bound.left[t]) {
      continue;
    }
    const double slope = std::clamp(0.0, before, after) - 0.5 * (bound.left[t] + bound.right[t]);
    const auto lower = [&](std::size_t i) {
      const double parabola =
          given[t] + bound.value[i] - bound.value[t] + slope * (stations[i] - stations[t]);
      const bool below = parabola < given[i];
      squares[i] = std::clamp(parabola, 0.0, squares[i]);
      return below;
    };
    for (std::size_t i = t + 1; i < count && lower(i); ++i) {
    }
    for (std::size_t i = t; i-- > 0 && lower(i);) {
    }
  }
}

/// Replaces the squared speeds by w2, the result of step 2 of LimitJerk.
void LowerToHull(const std::vector<double>& stations, const Bound& bound,
                 std::vector<double>& squares) {
  std::vector<std::size_t> hull;
  const auto height = [&](std::size_t i) { return squares[i] + bound.value[i]; };
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto above = [&] {
      const std::size_t a = hull[hull.size() - 2];
      const std::size_t b = hull.back();
      return (height(b) - height(a)) * (stations[i] - stations[a]) >=
             (height(i) - height(a)) * (stations[b] - stations[a]);
    };
    while (hull.size() >= 2 && above()) {
      hull.pop_back();
    }
    hull.push_back(i);
  }
  std::vector<double> lowered = squares;
  for (std::size_t k = 1; k < hull.size(); ++k) {
    const std::size_t a = hull[k - 1];
    const std::size_t b = hull[k];
    const double slope = (height(b) - height(a)) / (stations[b] - stations[a]);
    for (std::size_t i = a + 1; i < b; ++i) {
      const double line = height(a) + slope * (stations[i] - stations[a]);
      lowered[i] = std::clamp(line - bound.value[i], 0.0, squares[i]);
    }
  }
  squares = std::move(lowered);
}

}  // namespace

void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares) {
  const Bound bound = Integrate(stations, jerk, squares);
  LowerValleys(stations, bound, squares);
  LowerToHull(stations, bound, squares);
}

void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares) {
  // Place the lap between two copies of itself, so that the result is periodic.
  const double length = stations.back() - stations.front();
  const std::size_t count = stations.size() - 1;
  std::vector<double> long_stations;
  std::vector<double> long_squares;
  for (int lap = -1; lap <= 1; ++lap) {
    for (std::size_t i = 0; i < count; ++i) {
      long_stations.push_back(stations[i] - stations.front() + lap * length);
      long_squares.push_back(squares[i]);
    }
  }
  LimitJerk(long_stations, jerk, long_squares);
  for (std::size_t i = 0; i < count; ++i) {
    squares[i] = long_squares[count + i];
  }
  squares.back() = squares.front();
}

}  // namespace trackbed
