#include "src/recording/log_globe.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "src/recording/local_polynomial.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/globe_names.h"

namespace trackbed {

void ProjectRows(const std::filesystem::path& log, const LogPosition& map, std::vector<int>& lines,
                 LogRows& rows) {
  std::vector<GlobePosition> positions;
  for (const Vec2& degrees : rows.position) {
    positions.push_back({.latitude = degrees.y(), .longitude = degrees.x()});
  }
  const std::vector<std::size_t> without = PositionsWithoutFix(positions);
  if (!without.empty()) {
    rows.notes.push_back(
        NoFixNote(without.size(), fmt::format("in line {}", lines[without.front()])));
    std::size_t kept = 0;
    auto skipped = without.begin();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (skipped != without.end() && *skipped == i) {
        ++skipped;
        continue;
      }
      positions[kept] = positions[i];
      rows.time[kept] = rows.time[i];
      rows.yaw[kept] = rows.yaw[i];
      lines[kept] = lines[i];
      ++kept;
    }
    positions.resize(kept);
    rows.time.resize(kept);
    rows.yaw.resize(kept);
    rows.position.resize(kept);
  }
  if (positions.empty()) {
    return;
  }
  const std::optional<GlobePosition> origin =
      map.origin_latitude && map.origin_longitude
          ? std::optional(GlobePosition{*map.origin_latitude, *map.origin_longitude})
          : std::nullopt;
  GlobePoints projected = ProjectGlobe(positions, origin);
  if (!projected.problem.empty()) {
    throw InputError(Problem{.file = log.string(),
                             .line = lines[projected.bad],
                             .key = *map.latitude,
                             .message = projected.problem});
  }
  rows.position = std::move(projected.points);
  rows.notes.push_back(projected.note);
}

void CheckHemispheres(const std::filesystem::path& log, const LogPosition& map, char delimiter) {
  std::vector<std::string> names;
  std::vector<std::size_t> letters;  // columns whose names are usual for hemispheres
  ProblemList problems;
  const auto take_names = [&](std::vector<std::string>& found, int /*line*/) {
    names = std::move(found);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (NamesHemisphere(names[i])) {
        letters.push_back(i);
      }
    }
  };
  const auto is_positive = [&](const std::vector<std::string>& cells, const std::string& column) {
    const auto at = std::find(names.begin(), names.end(), column) - names.begin();
    const auto index = static_cast<std::size_t>(at);
    return index < cells.size() && CellNumber(cells[index]).value_or(0.0) > 0.0;
  };
  const auto take_row = [&](std::vector<std::string>& cells, int line) {
    for (const std::size_t i : letters) {
      const std::string cell = i < cells.size() ? cells[i] : "";
      const bool is_south = cell == "S" || cell == "s";
      const bool is_west = cell == "W" || cell == "w";
      if ((is_south && is_positive(cells, *map.latitude)) ||
          (is_west && is_positive(cells, *map.longitude))) {
        problems.Add({log.string(), line, 0, names[i],
                      fmt::format("'{}' beside a positive {}; write {} as negative numbers", cell,
                                  is_south ? "latitude" : "longitude",
                                  is_south ? "southern latitudes" : "western longitudes")});
      }
    }
  };
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  ReadCsvTable(log, {.max_cells = kAny, .max_bytes = kAny, .delimiter = delimiter}, problems,
               take_names, take_row);
  problems.ThrowIfAny();
}

void TakeHeadings(const std::filesystem::path& log, const LogMap& map, LogRows& rows) {
  // Speed above which the direction of motion is not noise of the positions [m/s].
  constexpr double kMoving = 0.5;
  const std::size_t count = rows.time.size();
  Eigen::MatrixXd values(static_cast<Eigen::Index>(count), 2);
  for (std::size_t i = 0; i < count; ++i) {
    values.row(static_cast<Eigen::Index>(i)) = rows.position[i];
  }
  const LocalPolynomial fits(rows.time, values, map.resample.half_width, map.resample.degree);
  std::vector<bool> moves(count, false);
  for (const LogStretch& stretch : SplitAtGaps(rows.time, map.gap)) {
    for (std::size_t i = stretch.first; i < stretch.end; ++i) {
      const Vec2 velocity = fits.At(rows.time[i], stretch).row(1);
      moves[i] = velocity.norm() > kMoving;
      rows.yaw[i] = std::atan2(velocity.y(), velocity.x());
    }
  }
  const auto first = std::find(moves.begin(), moves.end(), true);
  if (const std::string problem = GapProblem(rows.time, map.gap);
      first == moves.end() && !problem.empty()) {
    throw InputError(Problem{.file = log.string(), .message = problem});
  }
  if (first == moves.end()) {
    throw InputError(Problem{
        .file = log.string(),
        .key = "heading_from_motion",
        .message = fmt::format("the position never moves faster than {} m/s between rows that are "
                               "at most {} s apart (gap), so it has no direction of motion",
                               kMoving, map.gap)});
  }
  // While the car stands, it keeps its heading.
  double last = rows.yaw[static_cast<std::size_t>(first - moves.begin())];
  std::size_t standing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    last = moves[i] ? rows.yaw[i] : last;
    rows.yaw[i] = last;
    standing += moves[i] ? 0U : 1U;
  }
  rows.notes.push_back(fmt::format(
      "the yaw is the direction of motion of the measured point{}",
      standing > 0 ? fmt::format("; in {} rows slower than {} m/s, the last yaw", standing, kMoving)
                   : std::string()));
}

}  // namespace trackbed
