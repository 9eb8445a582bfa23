#include "src/path_files/globe_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Makes a path of one line of a GPX, KML or GeoJSON file. Segments of one track are joined if the
// gap between them is not longer than the longest step within them. A gap of at most the longest
// step looks like any other step of the track. All other segments and lines are separate paths, and
// the user selects one of these paths.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Distance between two positions on a sphere [m], by the haversine formula.
double Distance(const GlobePoint& a, const GlobePoint& b) {
  constexpr double kRadius = 6.371e6;
  constexpr double kRadians = 3.14159265358979323846 / 180.0;
  const double latitude = kRadians * (b.position.latitude - a.position.latitude);
  const double longitude = kRadians * (b.position.longitude - a.position.longitude);
  const double h =
      std::pow(std::sin(0.5 * latitude), 2.0) + std::cos(kRadians * a.position.latitude) *
                                                    std::cos(kRadians * b.position.latitude) *
                                                    std::pow(std::sin(0.5 * longitude), 2.0);
  return 2.0 * kRadius * std::asin(std::min(1.0, std::sqrt(h)));
}

double LongestStep(const std::vector<GlobePoint>& points) {
  double longest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    longest = std::max(longest, Distance(points[i - 1], points[i]));
  }
  return longest;
}

double LineLength(const std::vector<GlobePoint>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += Distance(points[i - 1], points[i]);
  }
  return length;
}

void DropWithoutFix(GlobeFile& file, std::vector<std::string>& notes) {
  std::vector<GlobePosition> all;
  for (const GlobeLine& line : file.lines) {
    for (const GlobePoint& point : line.points) {
      all.push_back(point.position);
    }
  }
  const std::vector<std::size_t> without = PositionsWithoutFix(all);
  if (without.empty()) {
    return;
  }
  std::string first;
  for (GlobeLine& line : file.lines) {
    std::erase_if(line.points, [&](const GlobePoint& point) {
      const bool is_zero = point.position.latitude == 0.0 && point.position.longitude == 0.0;
      if (is_zero && first.empty()) {
        first = fmt::format("in {}, line {}", line.name, point.line);
      }
      return is_zero;
    });
  }
  std::erase_if(file.lines, [](const GlobeLine& line) { return line.points.empty(); });
  notes.push_back(NoFixNote(without.size(), first));
}

/// Joins successive segments of a track whose gap is not longer than the longest step.
std::vector<GlobeLine> Joined(std::vector<GlobeLine> lines, std::vector<std::string>& notes) {
  std::vector<GlobeLine> joined;
  for (GlobeLine& line : lines) {
    if (!joined.empty() && joined.back().track == line.track) {
      GlobeLine& last = joined.back();
      const double gap = Distance(last.points.back(), line.points.front());
      const double step = std::max(LongestStep(last.points), LongestStep(line.points));
      if (gap <= step) {
        notes.push_back(
            fmt::format("{} is joined to the segment before, over {:.3g} m", line.name, gap));
        last.points.insert(last.points.end(), line.points.begin(), line.points.end());
        continue;
      }
    }
    joined.push_back(std::move(line));
  }
  return joined;
}

/// Drops lines of a single point, which are no paths, unless the file has no other lines.
void DropSinglePoints(std::vector<GlobeLine>& lines, std::vector<std::string>& notes) {
  const auto is_single = [](const GlobeLine& line) { return line.points.size() < 2; };
  const auto count = std::count_if(lines.begin(), lines.end(), is_single);
  if (count > 0 && static_cast<std::size_t>(count) < lines.size()) {
    std::erase_if(lines, is_single);
    notes.push_back(
        fmt::format("{} {} of a single point skipped", count, count == 1 ? "line" : "lines"));
  }
}

GlobeLine Selected(std::vector<GlobeLine> lines, const std::string& format, int wanted,
                   const fs::path& file) {
  if (wanted == 0 && lines.size() == 1) {
    return std::move(lines.front());
  }
  if (wanted > 0 && static_cast<std::size_t>(wanted) <= lines.size()) {
    return std::move(lines[static_cast<std::size_t>(wanted) - 1]);
  }
  std::string list;
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(lines.size(), kShown); ++i) {
    list += fmt::format("{}{}: {}, {} points, {:.4g} m", i == 0 ? "" : "; ", i + 1, lines[i].name,
                        lines[i].points.size(), LineLength(lines[i].points));
  }
  list += lines.size() > kShown ? fmt::format("; and {} more", lines.size() - kShown) : "";
  if (wanted > 0) {
    Refuse(file, "line",
           fmt::format("{} is not in the file, which has {} ({})", wanted, lines.size(), list));
  }
  Refuse(file, "",
         fmt::format("{} {}s; must be one, or select one by line: 1 to line: {} ({})", lines.size(),
                     format == "GeoJSON" ? "line string" : "line", lines.size(), list));
}

}  // namespace

std::optional<GlobePosition> OriginOf(const PathMap& map) {
  return map.origin_latitude && map.origin_longitude
             ? std::optional(GlobePosition{*map.origin_latitude, *map.origin_longitude})
             : std::nullopt;
}

PathFile PathOfGlobeFile(const fs::path& file, GlobeFile lines, const PathMap& map) {
  PathFile found;
  DropWithoutFix(lines, found.notes);
  const std::size_t given = lines.lines.size();
  std::vector<GlobeLine> joined = Joined(std::move(lines.lines), found.notes);
  DropSinglePoints(joined, found.notes);
  const std::size_t count = joined.size();
  const GlobeLine line = Selected(std::move(joined), lines.format, map.line, file);
  std::vector<GlobePosition> positions;
  std::vector<double> times;
  for (const GlobePoint& point : line.points) {
    positions.push_back(point.position);
    found.points.lines.push_back(point.line);
    if (point.time) {
      times.push_back(*point.time);
    }
  }
  GlobePoints projected = ProjectGlobe(positions, OriginOf(map));
  if (!projected.problem.empty()) {
    Refuse(file, line.name, projected.problem, line.points[projected.bad].line);
  }
  found.points.points = std::move(projected.points);
  const std::string which =
      given > 1 ? fmt::format(", {}{}", line.name, count > 1 ? fmt::format(" of {}", count) : "")
                : std::string();
  found.notes.insert(found.notes.begin(),
                     fmt::format("{}{}", lines.format, which) + ", " + projected.note);
  if (!times.empty() && times.size() == positions.size()) {
    TakeTimes(found, std::move(times), file.string());
  } else if (!times.empty()) {
    found.speed_problems.push_back(
        {.file = file.string(),
         .key = "time",
         .message = fmt::format("{} of {} points have a time; must be all or none", times.size(),
                                positions.size())});
  }
  return found;
}

}  // namespace trackbed
