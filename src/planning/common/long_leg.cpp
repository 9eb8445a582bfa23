#include "trackbed/planning/common/long_leg.h"

#include <algorithm>
#include <limits>

#include "trackbed/core/error.h"

// Finds where a path passes waypoints by dynamic programming over samples of the path. The table
// contains the smallest sum of the distances of the first i waypoints from the path. In the row of
// a sample, the path passes the waypoint i at this sample or earlier.

namespace trackbed {
namespace {

/// Returns the indices of the samples at which the path passes the waypoints, in order.
std::vector<std::size_t> PassedAt(const std::vector<PathPoint>& samples,
                                  const std::vector<Vec2>& waypoints) {
  const std::size_t count = samples.size();
  std::vector<std::vector<std::size_t>> passed(waypoints.size());
  std::vector<double> sums(count, 0.0);
  for (std::size_t i = 1; i + 1 < waypoints.size(); ++i) {
    passed[i].resize(count);
    double least = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double sum = sums[k] + (samples[k].pose.position() - waypoints[i]).norm();
      if (sum < least) {
        least = sum;
        at = k;
      }
      passed[i][k] = at;
      sums[k] = least;
    }
  }
  std::vector<std::size_t> order(waypoints.size(), 0);
  order.back() = count - 1;
  for (std::size_t i = waypoints.size() - 1; i-- > 1;) {
    order[i] = passed[i][order[i + 1]];
  }
  return order;
}

}  // namespace

std::optional<LongLeg> LongestLeg(const Path& path, const std::vector<Vec2>& waypoints,
                                  double excess) {
  TRACKBED_CHECK(excess > 0.0, "an excess of {} m", excess);
  double straight = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    straight += (waypoints[i] - waypoints[i - 1]).norm();
  }
  if (waypoints.size() < 2 || path.length() < straight + excess) {
    return std::nullopt;
  }
  const std::vector<PathPoint> samples =
      path.Sample(std::max(excess / 16.0, path.length() / 10'000.0));
  const std::vector<std::size_t> order = PassedAt(samples, waypoints);
  std::optional<LongLeg> longest;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const LongLeg leg{.to = i,
                      .length = samples[order[i]].s - samples[order[i - 1]].s,
                      .straight = (waypoints[i] - waypoints[i - 1]).norm()};
    if (leg.length >= leg.straight + excess &&
        (!longest || leg.length - leg.straight > longest->length - longest->straight)) {
      longest = leg;
    }
  }
  return longest;
}

}  // namespace trackbed
