#include "trackbed/path_files/path_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestText = std::size_t{16} << 20U;

std::string Ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// By the ending; of .json by what it holds. Other endings are tables.
PathFormat FormatOf(const fs::path& file) {
  const std::string ending = Ending(file);
  if (ending == ".xml") {
    return PathFormat::kCommonRoad;
  }
  if (ending == ".geojson") {
    return PathFormat::kGeoJson;
  }
  return ending == ".yaml" || ending == ".yml" || ending == ".json" ? PathFormat::kNavPath
                                                                    : PathFormat::kCsv;
}

PathFile Read(const fs::path& file, const PathMap& map) {
  const std::string name = file.string();
  const PathFormat format = map.format == PathFormat::kAuto ? FormatOf(file) : map.format;
  if (format == PathFormat::kCsv) {
    return ReadPathCsv(file, map.columns);
  }
  const std::string text = ReadFile(file, kLargestText);
  if (format == PathFormat::kCommonRoad) {
    return ReadCommonRoad(file, text);
  }
  if (format == PathFormat::kGeoJson) {
    return ReadGeoJson(file, ParseJsonText(text, name), map);
  }
  if (Ending(file) != ".json") {
    return ReadNavPath(file, ParseYamlText(text, name));
  }
  const nlohmann::json value = ParseJsonText(text, name);
  const bool is_geographic = map.format == PathFormat::kAuto && value.is_object() &&
                             value.contains("type") && !value.contains("poses");
  return is_geographic ? ReadGeoJson(file, value, map) : ReadNavPath(file, value);
}

}  // namespace

void Refuse(const fs::path& file, const std::string& key, std::string message, int line) {
  throw InputError(
      Problem{.file = file.string(), .line = line, .key = key, .message = std::move(message)});
}

void AddSpeeds(PathPoints& points, const std::vector<double>& times, const std::string& file) {
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double duration = times[i + 1] - times[i];
    if (duration <= 0.0) {
      Refuse(file, "time",
             fmt::format("{} s of point {} must be above the previous point's {} s", times[i + 1],
                         i + 2, times[i]));
    }
    const double speed = (points.points[i + 1] - points.points[i]).norm() / duration;
    if (speed > kFastest) {
      Refuse(file, "time",
             fmt::format("{:.4g} m/s from point {} to the next; must be at most {} m/s", speed,
                         i + 1, kFastest));
    }
    points.speed.push_back(speed);
  }
  if (!points.speed.empty()) {
    points.speed.push_back(points.speed.back());
  }
}

bool IsNavPathYaml(const fs::path& file) {
  try {
    const nlohmann::json root = ParseYamlText(ReadFile(file, kLargestText), file.string());
    const auto has_poses = [](const nlohmann::json& node) {
      return node.is_object() && node.contains("poses");
    };
    return has_poses(root) ||
           (root.is_object() && root.contains("path") && has_poses(root.at("path")));
  } catch (const InputError&) {
    return false;
  } catch (const RunError&) {
    return false;
  }
}

PathFile ReadPathFile(const fs::path& file, const PathMap& map) {
  std::vector<Problem> problems;
  for (auto& [key, message] : PathMapProblems(map)) {
    problems.push_back({.key = key, .message = std::move(message)});
  }
  if (!problems.empty()) {
    throw InputError(std::move(problems));
  }
  PathFile found = Read(file, map);
  const std::size_t count = found.points.points.size();
  if (count < 2) {
    Refuse(file, "",
           fmt::format("{} point{}; a path has at least 2", count, count == 1 ? "" : "s"));
  }
  return found;
}

}  // namespace trackbed
