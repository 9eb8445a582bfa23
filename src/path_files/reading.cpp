#include "src/path_files/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double duration = times[i + 1] - times[i];
    if (duration <= 0.0) {
      drop(i + 1, fmt::format("{} s of point {} must be above the previous point's {} s",
                              times[i + 1], i + 2, times[i]));
      return;
    }
    if (has_speeds) {
      continue;
    }
    const double speed = (points.points[i + 1] - points.points[i]).norm() / duration;
    if (speed > kMaxPathSpeed) {
      drop(i + 1, fmt::format("{:.4g} m/s from point {} to the next; must be at most {} m/s", speed,
                              i + 1, kMaxPathSpeed));
      return;
    }
    points.speed.push_back(speed);
  }
  if (!has_speeds && !points.speed.empty()) {
    points.speed.push_back(points.speed.back());
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
