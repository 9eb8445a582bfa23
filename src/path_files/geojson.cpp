#include <fmt/format.h>
#include <proj.h>

#include <cmath>
#include <memory>
#include <optional>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"

// Reads a path from GeoJSON (RFC 7946). The file must contain one line string, alone, in a feature
// or in a collection of features.
namespace trackbed {
namespace {

using nlohmann::json;

struct Found {
  const json* coordinates = nullptr;
  std::string key;
  std::size_t lines = 0;
};

std::string TypeOf(const json& value) {
  return value.is_object() && value.contains("type") && value["type"].is_string()
             ? value["type"].get<std::string>()
             : "";
}

/// Collects all line strings in features and geometry collections, and ignores other geometries.
void FindLines(const json& value, const std::string& key, Found& found) {
  const std::string type = TypeOf(value);
  const auto inside = [&](const char* name) {
    if (value.contains(name) && value[name].is_array()) {
      for (std::size_t i = 0; i < value[name].size(); ++i) {
        FindLines(value[name][i], fmt::format("{}{}[{}].", key, name, i), found);
      }
    }
  };
  if (type == "FeatureCollection") {
    inside("features");
  } else if (type == "GeometryCollection") {
    inside("geometries");
  } else if (type == "Feature" && value.contains("geometry")) {
    FindLines(value["geometry"], key + "geometry.", found);
  } else if (type == "LineString" && value.contains("coordinates")) {
    ++found.lines;
    found.coordinates = &value["coordinates"];
    found.key = key + "coordinates";
  } else if (type == "MultiLineString" && value.contains("coordinates") &&
             value["coordinates"].is_array()) {
    for (std::size_t i = 0; i < value["coordinates"].size(); ++i) {
      ++found.lines;
      found.coordinates = &value["coordinates"][i];
      found.key = fmt::format("{}coordinates[{}]", key, i);
    }
  }
}

/// Returns the name of the coordinate reference system, which GeoJSON 2008 specifies in the member
/// `crs`. Returns none if the member `crs` is absent.
std::optional<std::string> NamedSystem(const json& root) {
  if (root.contains("crs") && root["crs"].is_object() && root["crs"].contains("properties") &&
      root["crs"]["properties"].is_object() && root["crs"]["properties"].contains("name") &&
      root["crs"]["properties"]["name"].is_string()) {
    return root["crs"]["properties"]["name"].get<std::string>();
  }
  return std::nullopt;
}

bool IsWgs84(const std::string& system) {
  return system.find("CRS84") != std::string::npos || system.ends_with("4326");
}

/// Converts longitude and latitude to meters by a transverse Mercator projection centered at an
/// origin.
class Projection84 {
 public:
  Projection84(double longitude, double latitude)
      : context_(proj_context_create(), proj_context_destroy), projection_(nullptr, proj_destroy) {
    const std::string definition =
        fmt::format("+proj=tmerc +lat_0={:.12f} +lon_0={:.12f} +k=1 +ellps=WGS84 +units=m",
                    latitude, longitude);
    projection_.reset(proj_create(context_.get(), definition.c_str()));
    TRACKBED_CHECK(projection_ != nullptr, "PROJ does not know {}", definition);
  }

  [[nodiscard]] Vec2 ToMeters(double longitude, double latitude) const {
    const PJ_COORD at = proj_trans(projection_.get(), PJ_FWD,
                                   proj_coord(proj_torad(longitude), proj_torad(latitude), 0, 0));
    return {at.xy.x, at.xy.y};
  }

 private:
  std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context_;
  std::unique_ptr<PJ, PJ* (*)(PJ*)> projection_;
};

/// Returns the first two numbers of each position; ignores the third number, the height.
std::vector<Vec2> Positions(const Found& found, const std::string& file, double largest) {
  const json& list = *found.coordinates;
  if (!list.is_array()) {
    Refuse(file, found.key, "must be a list of positions");
  }
  std::vector<Vec2> positions;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string key = fmt::format("{}[{}]", found.key, i);
    if (!list[i].is_array() || list[i].size() < 2 || list[i].size() > 4) {
      Refuse(file, key, "must be a position of two or three numbers");
    }
    positions.emplace_back(NumberOf(list[i][0], key + "[0]", largest, file),
                           NumberOf(list[i][1], key + "[1]", largest, file));
  }
  return positions;
}

void Project(std::vector<Vec2>& positions, const Found& line, const PathMap& map,
             const std::string& file) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2& degrees = positions[i];
    if (std::abs(degrees.x()) > 180.0 || std::abs(degrees.y()) > 89.0) {
      Refuse(file, fmt::format("{}[{}]", line.key, i),
             fmt::format("({}, {}) are no longitude and latitude in degrees; if these are meters, "
                         "say coordinates: meters",
                         degrees.x(), degrees.y()));
    }
  }
  const double latitude = map.origin_latitude.value_or(positions.front().y());
  const double longitude = map.origin_longitude.value_or(positions.front().x());
  const Projection84 projection(longitude, latitude);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 degrees = positions[i];
    positions[i] = projection.ToMeters(degrees.x(), degrees.y());
    // Largest distance of a path point east or west of the origin [m]. At this distance, the scale
    // error of the projection is about 1/1000 (scale at 300 km: 1.0011).
    constexpr double kMaxEasting = 3e5;
    if (!positions[i].allFinite() || std::abs(positions[i].x()) > kMaxEasting ||
        std::abs(positions[i].y()) > kMaxPosition) {
      Refuse(file, fmt::format("{}[{}]", line.key, i),
             fmt::format("({}, {}) is too far from the origin of the projection, ({}, {})",
                         degrees.x(), degrees.y(), longitude, latitude));
    }
  }
}

}  // namespace

PathFile ReadGeoJson(const std::filesystem::path& path, const json& root, const PathMap& map) {
  const std::string file = path.string();
  Found line;
  FindLines(root, "", line);
  if (line.lines != 1) {
    Refuse(file, "", fmt::format("{} line strings; must be one", line.lines));
  }
  const std::optional<std::string> system = NamedSystem(root);
  const bool in_degrees =
      map.coordinates == PathCoordinates::kWgs84 ||
      (map.coordinates == PathCoordinates::kAuto && (!system || IsWgs84(*system)));
  PathFile found;
  found.points.points = Positions(line, file, kMaxPosition);
  if (found.points.points.empty()) {
    Refuse(file, line.key, "has no positions");
  }
  if (in_degrees) {
    const Vec2 first = found.points.points.front();
    Project(found.points.points, line, map, file);
    found.notes.push_back(fmt::format(
        "GeoJSON, WGS 84 by transverse Mercator about latitude {:.7g}, longitude {:.7g}, x east, y "
        "north",
        map.origin_latitude.value_or(first.y()), map.origin_longitude.value_or(first.x())));
  } else {
    found.notes.push_back("GeoJSON, meters" + (system ? " of " + *system : std::string()));
  }
  return found;
}

}  // namespace trackbed
