#include "trackbed/planning/common/long_leg.h"

#include <algorithm>
#include <limits>

#include "trackbed/core/error.h"

// Finds where a path passes waypoints by dynamic programming over samples of the path. Hirschberg's
// divide and conquer (1975) needs memory for one row of the table only: the sums of the waypoints
// before and behind the middle waypoint give the sample of the middle waypoint. The same search
// then divides the waypoints and the samples on either side.

namespace trackbed {
namespace {

/// Assigns waypoints to samples of a path, in order, such that the sum of the distances is least.
class PassedSamples {
 public:
  PassedSamples(const std::vector<PathPoint>& samples, const std::vector<Vec2>& waypoints)
      : samples_(samples),
        waypoints_(waypoints),
        order_(waypoints.size(), 0),
        before_(samples.size()),
        behind_(samples.size()) {}

  /// Returns the indices of the samples at which the path passes the waypoints.
  [[nodiscard]] std::vector<std::size_t> Find() && {
    order_.back() = samples_.size() - 1;
    Assign(1, waypoints_.size() - 1, 0, samples_.size() - 1);
    return std::move(order_);
  }

 private:
  [[nodiscard]] double Distance(std::size_t sample, std::size_t waypoint) const {
    return (samples_[sample].pose.position() - waypoints_[waypoint]).norm();
  }

  /// Assigns the waypoints in [first, end) to samples in [from, to].
  void Assign(std::size_t first, std::size_t end, std::size_t from, std::size_t to) {
    if (first >= end) {
      return;
    }
    const std::size_t middle = first + (end - first) / 2;
    // Least sum of the waypoints before the middle, whose samples are at most k.
    for (std::size_t k = from; k <= to; ++k) {
      before_[k] = behind_[k] = 0.0;
    }
    for (std::size_t i = first; i < middle; ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = from; k <= to; ++k) {
        least = std::min(least, before_[k] + Distance(k, i));
        before_[k] = least;
      }
    }
    // Least sum of the waypoints behind the middle, whose samples are at least k.
    for (std::size_t i = end; i-- > middle + 1;) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = to + 1; k-- > from;) {
        least = std::min(least, behind_[k] + Distance(k, i));
        behind_[k] = least;
      }
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = from; k <= to; ++k) {
      const double sum = before_[k] + Distance(k, middle) + behind_[k];
      if (sum < least) {
        least = sum;
        order_[middle] = k;
      }
    }
    Assign(first, middle, from, order_[middle]);
    Assign(middle + 1, end, order_[middle], to);
  }

  const std::vector<PathPoint>& samples_;
  const std::vector<Vec2>& waypoints_;
  std::vector<std::size_t> order_;
  std::vector<double> before_;
  std::vector<double> behind_;
};

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
  const std::vector<std::size_t> order = PassedSamples(samples, waypoints).Find();
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
