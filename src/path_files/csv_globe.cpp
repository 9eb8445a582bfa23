#include "src/path_files/csv_globe.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/spelling.h"
#include "trackbed/path_files/globe_names.h"

namespace trackbed {

CsvGlobe FindCsvGlobe(const std::vector<std::string>& names, const PathColumns& requested,
                      bool has_plane) {
  CsvGlobe found;
  if (requested.latitude && requested.longitude) {
    const auto take = [&](const std::string& wanted, std::optional<std::size_t>& index,
                          double& unit) {
      const auto at = std::find(names.begin(), names.end(), wanted);
      if (at == names.end()) {
        found.problems.emplace_back(wanted,
                                    fmt::format("no such column {}", UnknownName(wanted, names)));
        return;
      }
      index = static_cast<std::size_t>(at - names.begin());
      unit = GlobeColumnOf(wanted).value_or(GlobeColumn{}).degrees;
    };
    take(*requested.latitude, found.latitude, found.latitude_unit);
    take(*requested.longitude, found.longitude, found.longitude_unit);
  } else if (!has_plane) {
    const GlobeColumns usual = FindGlobeColumns(names);
    found.latitude = usual.latitude;
    found.longitude = usual.longitude;
    found.latitude_unit = usual.latitude_meaning.degrees;
    found.longitude_unit = usual.longitude_meaning.degrees;
  }
  if (!found.latitude || !found.longitude) {
    found.latitude.reset();
    found.longitude.reset();
  } else if (requested.position_unit == "rad") {
    found.latitude_unit = found.longitude_unit = 180.0 / kPi;
  } else if (requested.position_unit) {
    found.latitude_unit = found.longitude_unit = 1.0;
  }
  return found;
}

std::vector<std::pair<std::string, std::string>> CsvGlobeProblems(
    const GlobePosition& position, const std::vector<std::string>& names,
    const std::vector<std::string>& cells) {
  std::vector<std::pair<std::string, std::string>> problems;
  if (std::string problem = GlobeProblem(position); !problem.empty()) {
    problems.emplace_back("", std::move(problem));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_south = cells[i] == "S" || cells[i] == "s";
    const bool is_west = cells[i] == "W" || cells[i] == "w";
    const double number = is_south ? position.latitude : position.longitude;
    if ((is_south || is_west) && number > 0.0 && NamesHemisphere(names[i])) {
      problems.emplace_back(
          names[i], fmt::format("'{}' beside the {} {}; write {} as negative numbers", cells[i],
                                is_south ? "latitude" : "longitude", number,
                                is_south ? "southern latitudes" : "western longitudes"));
    }
  }
  return problems;
}

void ProjectCsv(PathFile& path, std::vector<double>& times,
                const std::optional<GlobePosition>& origin, const std::filesystem::path& file) {
  PathPoints& points = path.points;
  std::vector<GlobePosition> positions;
  for (const Vec2& degrees : points.points) {
    positions.push_back({.latitude = degrees.y(), .longitude = degrees.x()});
  }
  if (positions.empty()) {
    return;
  }
  const std::vector<std::size_t> without = PositionsWithoutFix(positions);
  if (!without.empty()) {
    path.notes.push_back(
        NoFixNote(without.size(), fmt::format("in line {}", points.lines[without.front()])));
  }
  const auto drop = [&](auto& list) {
    if (list.empty()) {
      return;
    }
    std::size_t kept = 0;
    auto skipped = without.begin();
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (skipped != without.end() && *skipped == i) {
        ++skipped;
      } else {
        list[kept++] = list[i];
      }
    }
    list.resize(kept);
  };
  drop(positions);
  drop(points.lines);
  drop(points.yaw);
  drop(points.curvature);
  drop(points.speed);
  drop(points.direction);
  drop(times);
  GlobePoints projected = ProjectGlobe(positions, origin);
  if (!projected.problem.empty()) {
    Refuse(file, "", projected.problem, points.lines[projected.bad]);
  }
  points.points = std::move(projected.points);
  path.notes.push_back(projected.note);
}

}  // namespace trackbed
