#include "src/path_files/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {

namespace fs = std::filesystem;

std::string LowerEnding(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void Refuse(const fs::path& file, const std::string& key, std::string message, int line) {
  throw InputError(
      Problem{.file = file.string(), .line = line, .key = key, .message = std::move(message)});
}

namespace {

/// Returns the first point whose time is below the time of its predecessor, or the second point if
/// all times are equal. Returns the number of points if the times are valid.
std::size_t FirstTimeOutOfOrder(const std::vector<double>& times) {
  if (times.size() > 1 && times.front() == times.back() &&
      std::is_sorted(times.begin(), times.end())) {
    return 1;
  }
  return static_cast<std::size_t>(std::is_sorted_until(times.begin(), times.end()) - times.begin());
}

/// Separates the times of points that share one time, as clocks with whole seconds write. The speed
/// is constant from the first point with a shared time to the next point with another time. If no
/// point with a later time follows, the speed is that of the previous step. Returns the speed of
/// each step [m/s].
std::vector<double> SpreadEqualTimes(const std::vector<Vec2>& points, std::vector<double>& times) {
  std::vector<double> step_speeds;
  std::size_t first = 0;
  while (first + 1 < times.size()) {
    std::size_t next = first + 1;
    while (next < times.size() && times[next] == times[first]) {
      ++next;
    }
    const std::size_t end = std::min(next, times.size() - 1);
    double length = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      length += (points[i + 1] - points[i]).norm();
    }
    const bool is_last = next == times.size();
    const double before = step_speeds.empty() ? 0.0 : step_speeds.back();
    const double speed = is_last ? before : length / (times[next] - times[first]);
    const double pace = speed > 0.0 ? 1.0 / speed : 0.0;
    for (std::size_t i = first; i < end; ++i) {
      if (i + 1 < next) {
        times[i + 1] = times[i] + pace * (points[i + 1] - points[i]).norm();
      }
      step_speeds.push_back(speed);
    }
    first = next;
  }
  return step_speeds;
}

}  // namespace

void TakeTimes(PathFile& found, std::vector<double> times, const std::string& file) {
  PathPoints& points = found.points;
  const bool has_speeds = !points.speed.empty();
  const auto drop = [&](std::size_t point, std::string message) {
    points.speed.clear();
    found.speed_problems.push_back({.file = file,
                                    .line = points.lines.empty() ? 0 : points.lines[point],
                                    .key = "time",
                                    .message = std::move(message)});
  };
  if (const std::size_t wrong = FirstTimeOutOfOrder(times); wrong < times.size()) {
    drop(wrong, fmt::format("{} s of point {} must be above the previous point's {} s",
                            times[wrong], wrong + 1, times[wrong - 1]));
    return;
  }
  const std::vector<double> step_speeds = SpreadEqualTimes(points.points, times);
  for (std::size_t i = 0; i < step_speeds.size() && !has_speeds; ++i) {
    if (step_speeds[i] > kMaxPathSpeed) {
      drop(i + 1, fmt::format("{:.4g} m/s from point {} to the next; must be at most {} m/s",
                              step_speeds[i], i + 1, kMaxPathSpeed));
      return;
    }
  }
  if (!has_speeds && !step_speeds.empty()) {
    points.speed = step_speeds;
    points.speed.push_back(step_speeds.back());
  }
  const double first = times.empty() ? 0.0 : times.front();
  for (double& time : times) {
    time -= first;
  }
  points.time = std::move(times);
}

void TakeStamps(PathFile& found, std::vector<double> stamps, const std::string& file) {
  const auto different = std::adjacent_find(stamps.begin(), stamps.end(), std::not_equal_to<>());
  if (stamps.size() != found.points.points.size() || different == stamps.end()) {
    return;
  }
  TakeTimes(found, std::move(stamps), file);
}

}  // namespace trackbed
