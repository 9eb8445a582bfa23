#include "src/track/track_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace trackbed {

TrackSteps StepsOf(const std::vector<TrackPoint>& points) {
  TrackSteps steps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    steps.lengths.push_back((points[(i + 1) % points.size()].position - points[i].position).norm());
  }
  std::vector<double> sorted = steps.lengths;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  steps.median = *middle;
  return steps;
}

void FillLongSteps(TrackRows& rows) {
  const std::size_t count = rows.points.size();
  const TrackSteps steps = StepsOf(rows.points);
  std::vector<TrackPoint> points;
  std::vector<int> lines;
  for (std::size_t i = 0; i < count; ++i) {
    const TrackPoint& from = rows.points[i];
    const TrackPoint& to = rows.points[(i + 1) % count];
    const double parts = steps.IsLong(i) ? std::ceil(steps.lengths[i] / (2.0 * steps.median)) : 1.0;
    if (points.size() + static_cast<std::size_t>(parts) > Track::kMaxPoints) {
      return;
    }
    for (double k = 0.0; k < parts; k += 1.0) {
      const double w = k / parts;
      points.push_back({from.position + w * (to.position - from.position),
                        std::lerp(from.width_right, to.width_right, w),
                        std::lerp(from.width_left, to.width_left, w)});
      lines.push_back(rows.lines[i]);
    }
  }
  if (points.size() == count) {
    return;
  }
  rows.notes.push_back(fmt::format(
      "{} points are added on the straight lines between points that are more than {:.4g} m apart, "
      "four times the median distance",
      points.size() - count, 4.0 * steps.median));
  rows.points = std::move(points);
  rows.lines = std::move(lines);
}

}  // namespace trackbed
