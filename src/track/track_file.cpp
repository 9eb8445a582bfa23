#include "trackbed/track/track_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <system_error>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

constexpr std::uintmax_t kMaxTrackFileBytes = std::uintmax_t{16} << 20U;
constexpr double kMaxPosition = 1e5;     // Largest permitted |x| and |y| of a point [m].
constexpr double kMaxWidth = 1000.0;     // Largest permitted track width on either side [m].
constexpr double kMaxLapLength = 200e3;  // Largest permitted length of the lap [m].
// Largest permitted change of direction at a point [deg]; beyond this angle, the center line counts
// as turning back.
constexpr double kMaxTurn = 150.0;
constexpr const char* kFirstColumn = "# x_m";

void CheckSize(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored && size > kMaxTrackFileBytes) {
    throw InputError(Problem{
        .file = file.string(),
        .message = fmt::format("has {} bytes; a track has at most {}", size, kMaxTrackFileBytes)});
  }
}

/// Returns the name of the table's first column, which may include the '#' that begins the header.
const char* FindFirstColumn(const std::filesystem::path& file, const Table& table) {
  for (const char* name : {kFirstColumn, "#x_m", "x_m"}) {
    if (table.Find(name) >= 0) {
      return name;
    }
  }
  throw InputError(Problem{.file = file.string(),
                           .line = 1,
                           .message = "no column 'x_m'; the header of a track is "
                                      "'# x_m,y_m,w_tr_right_m,w_tr_left_m'"});
}

/// Rejects a center line that jumps back and forth, because such a line cannot be smoothed to a
/// track.
void CheckShape(const std::string& name, const std::vector<int>& lines,
                const std::vector<TrackPoint>& points, ProblemList& problems) {
  const std::size_t count = points.size();
  double length = 0.0;
  double longest = 0.0;
  std::size_t widest = 0;  // index of the point before the largest gap
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& here = points[i].position;
    const Vec2 before = here - points[(i + count - 1) % count].position;
    const Vec2 after = points[(i + 1) % count].position - here;
    length += after.norm();
    widest = after.norm() > longest ? i : widest;
    longest = std::max(longest, after.norm());
    const double turn = std::abs(AngleDifference(std::atan2(after.y(), after.x()),
                                                 std::atan2(before.y(), before.x()))) *
                        180.0 / std::numbers::pi;
    if (turn > kMaxTurn) {
      problems.Add({.file = name,
                    .line = lines[i],
                    .message = fmt::format("the center line turns back here, by {:.3g} degrees; "
                                           "must be at most {:.3g} from point to point",
                                           turn, kMaxTurn)});
    }
  }
  if (length > kMaxLapLength) {
    const int end = lines[(widest + 1) % count];
    problems.Add(
        {.file = name,
         .line = end,
         .message = fmt::format("a lap is {:.4g} km long; must be at most {:.4g}: the gap "
                                "between rows {} and {} is {:.7g} m",
                                length / 1e3, kMaxLapLength / 1e3, lines[widest], end, longest)});
  }
}

std::string DescribeFold(const TrackFold& fold) {
  return fold.width < fold.radius && fold.turn > 0.0
             ? fmt::format(
                   "the center line turns by {:.3g} rad within a quarter of the mean "
                   "distance of the points; must be at most half a circle: a point may be "
                   "wrong, or the smoothing too short",
                   fold.turn)
             : fmt::format(
                   "the center line bends on a radius of {:.3g} m, and the inner edge is "
                   "{:.3g} m from it; must be less than the radius, so that the edge does "
                   "not fold over",
                   fold.radius, fold.width);
}

}  // namespace

Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing) {
  CheckSize(file);
  const CsvExcerpt excerpt =
      ReadCsvExcerpt(file, {"y_m", "w_tr_right_m", "w_tr_left_m"}, {kFirstColumn, "#x_m", "x_m"});
  const Table& table = excerpt.table;
  const std::string name = file.string();
  const auto column = [&](const char* own) { return static_cast<std::size_t>(table.Find(own)); };
  const std::size_t x = column(FindFirstColumn(file, table));
  const std::size_t y = column("y_m");
  const std::size_t right = column("w_tr_right_m");
  const std::size_t left = column("w_tr_left_m");
  if (table.rows() < Track::kMinPoints || table.rows() > Track::kMaxPoints) {
    throw InputError(
        Problem{.file = name,
                .message = fmt::format("has {} points; a track has {} to {}", table.rows(),
                                       Track::kMinPoints, Track::kMaxPoints)});
  }
  ProblemList problems;
  std::vector<TrackPoint> points;
  const auto add = [&](std::size_t row, std::string key, std::string message) {
    problems.Add({name, excerpt.lines[row], 0, std::move(key), std::move(message)});
  };
  for (std::size_t row = 0; row < table.rows(); ++row) {
    points.push_back(
        {{table.at(row, x), table.at(row, y)}, table.at(row, right), table.at(row, left)});
    for (const auto& [key, value] :
         {std::pair{"x_m", table.at(row, x)}, {"y_m", table.at(row, y)}}) {
      if (std::abs(value) > kMaxPosition) {
        add(row, key,
            fmt::format("{} is out of range; must be between {} and {}", value, -kMaxPosition,
                        kMaxPosition));
      }
    }
    for (const auto& [key, value] :
         {std::pair{"w_tr_right_m", table.at(row, right)}, {"w_tr_left_m", table.at(row, left)}}) {
      if (!(value > 0.0) || value > kMaxWidth) {
        add(row, key,
            fmt::format("{} is out of range; must be above 0 and at most {}", value, kMaxWidth));
      }
    }
    if (row > 0 && points[row].position == points[row - 1].position) {
      add(row, "", "same point as in the row before");
    }
  }
  if (points.back().position == points.front().position) {
    add(points.size() - 1, "", "the first point again; a track is closed without it");
  }
  problems.ThrowIfAny();
  CheckShape(name, excerpt.lines, points, problems);
  problems.ThrowIfAny();
  const auto add_fold = [&](const TrackFold& fold) {
    add(fold.point, "", DescribeFold(fold));
    problems.ThrowIfAny();
  };
  if (const std::optional<TrackFold> fold = FindFold(points, smoothing)) {
    add_fold(*fold);
  }
  Track track(std::move(points), smoothing);
  if (const std::optional<TrackFold> fold = FindFold(track)) {
    add_fold(*fold);
  }
  for (std::size_t i = 0; i < track.points().size(); ++i) {
    const TrackEdges edges = track.EdgesAt(track.StationOf(i));
    if (edges.right >= 0.0 || edges.left <= 0.0) {
      add(i, "",
          fmt::format("smoothed over {:.4g} m, the center line leaves the track here; use a "
                      "shorter smoothing",
                      track.smoothing()));
      break;
    }
  }
  problems.ThrowIfAny();
  return track;
}

std::string TrackCsv(const std::vector<TrackPoint>& points) {
  Table table({kFirstColumn, "y_m", "w_tr_right_m", "w_tr_left_m"});
  for (const TrackPoint& point : points) {
    table.AddRow({point.position.x(), point.position.y(), point.width_right, point.width_left});
  }
  return table.ToCsv();
}

}  // namespace trackbed
