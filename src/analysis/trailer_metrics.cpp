#include "src/analysis/trailer_metrics.h"

#include <algorithm>
#include <cmath>

#include "src/analysis/peaks.h"

namespace trackbed {
namespace {

/// Returns the largest result of the function `value` over all log rows, with the station and time
/// of the row.
template <typename Value>
std::optional<MetricReading> LargestOverRows(const MetricInput& input, const Value& value) {
  if (!input.log.trailer || !input.log.rows.front().trailer) {
    return std::nullopt;
  }
  const LogRow* at = nullptr;
  double largest = -1.0;
  for (std::size_t i = 0; i < input.log.rows.size(); ++i) {
    const double own = value(i);
    if (own > largest) {
      largest = own;
      at = &input.log.rows[i];
    }
  }
  return MetricReading{largest,
                       {.span = MetricSpan::kMoment, .s = RowStation(*at), .t = at->state.time}};
}

double DistanceToSegment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double square = along.squaredNorm();
  const double part = square > 0.0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - a - part * along).norm();
}

/// Returns the distance of the trailer's axle from the line that the car has driven up to the log
/// row `row`.
double OffTracking(const RunLog& log, std::size_t row) {
  const TrailerParams& trailer = *log.trailer;
  const LogRow& now = log.rows[row];
  const Vec2 axle = TrailerPose(trailer, now.state.pose, now.trailer->angle).position();
  const double reach = trailer.hitch + trailer.tongue;
  // Search the driven line only over twice the distance between the axles of car and trailer,
  // because the nearest point of the driven line lies within this distance.
  double nearest = (axle - now.state.pose.position()).norm();
  std::size_t i = row;
  for (; i > 0 && now.state.distance - log.rows[i].state.distance < 2.0 * reach; --i) {
    nearest = std::min(nearest, DistanceToSegment(axle, log.rows[i - 1].state.pose.position(),
                                                  log.rows[i].state.pose.position()));
  }
  if (i == 0) {
    const Pose2& start = log.rows.front().state.pose;
    nearest = std::min(
        nearest, DistanceToSegment(axle, ToWorld(start, {-2.0 * reach, 0.0}), start.position()));
  }
  return nearest;
}

}  // namespace

std::optional<MetricReading> LargestHitchAngle(const MetricInput& input) {
  return LargestOverRows(input,
                         [&](std::size_t i) { return std::abs(input.log.rows[i].trailer->angle); });
}

std::optional<MetricReading> LargestHitchRate(const MetricInput& input) {
  return LargestOverRows(input,
                         [&](std::size_t i) { return std::abs(input.log.rows[i].trailer->rate); });
}

std::optional<MetricReading> LargestOffTracking(const MetricInput& input) {
  return LargestOverRows(input, [&](std::size_t i) { return OffTracking(input.log, i); });
}

}  // namespace trackbed
