#include "trackbed/scenario/map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "src/scenario/map_image.h"
#include "src/scenario/map_range.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/scenario/moving_ai.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

enum class MapMode { kTrinary, kScale };

/// Keys in the YAML file of a ROS map.
struct RosMapKeys {
  std::string image;
  double resolution = 0.0;     ///< Side length of a map pixel [m].
  std::vector<double> origin;  ///< Pose of the map's lower left corner: position x, y [m], and yaw
                               ///< [rad].
  std::string negate;
  double occupied_thresh = 0.0;
  double free_thresh = 0.0;
  MapMode mode = MapMode::kTrinary;
};

void Visit(KeyVisitor& keys, RosMapKeys& map) {
  constexpr Range kShare{.min = 0.0, .max = 1.0};
  keys.Field({"image", "", "PGM or PNG file"}, map.image, Need::kRequired);
  keys.Field({"resolution", "m", "side of a cell"}, map.resolution, Need::kRequired,
             Range{.min = 1e-3, .max = 1e3});
  keys.Field({"origin", "", "x, y and yaw of the lower left corner"}, map.origin, Need::kRequired,
             kPlace);
  keys.Field({"negate", "", "whether black is free"}, map.negate, Need::kRequired,
             Names{"0", "1", "false", "true"});
  keys.Field({"occupied_thresh", "", "darker is occupied"}, map.occupied_thresh, Need::kRequired,
             kShare);
  keys.Field({"free_thresh", "", "brighter is free"}, map.free_thresh, Need::kRequired, kShare);
  static const EnumNames<MapMode> modes{{MapMode::kTrinary, "trinary"}, {MapMode::kScale, "scale"}};
  keys.Field({"mode", "", "what the thresholds mean"}, map.mode, Need::kOptional, modes);
}

/// Reads a map file of at most kMaxMapFileBytes bytes. ReadMapFile throws InputError if the file
/// cannot be read.
std::string ReadMapFile(const fs::path& file) {
  try {
    return ReadFile(file, kMaxMapFileBytes);
  } catch (const RunError& error) {
    throw InputError(Problem{.message = error.what()});
  }
}

/// Removes the keys that other programs add to the YAML file of a map, because map_server also
/// ignores these keys. Keeps unknown keys that may be misspelled keys of a map, so that the reader
/// rejects the file.
void RemoveOtherKeys(YAML::Node& root) {
  static const std::vector<std::string> known{"image",           "resolution",  "origin", "negate",
                                              "occupied_thresh", "free_thresh", "mode"};
  std::vector<std::string> others;
  for (const auto& entry : root) {
    if (!root.IsMap() || !entry.first.IsScalar()) {
      return;
    }
    const std::string& name = entry.first.Scalar();
    if (std::find(known.begin(), known.end(), name) == known.end() &&
        NearestSpelling(name, known).empty()) {
      others.push_back(name);
    }
  }
  for (const std::string& name : others) {
    root.remove(name);
  }
}

RosMapKeys ReadRosMapKeys(const fs::path& file) {
  YAML::Node root = LoadYaml(ReadMapFile(file), file.string(), "a ROS map");
  RemoveOtherKeys(root);
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  RosMapKeys map;
  YamlReader reader(context, root, "");
  Visit(reader, map);
  reader.Finish();
  if (context.Read("origin") && map.origin.size() != 3) {
    context.AddError(NodeAt(root, "origin").Mark(), "origin",
                     fmt::format("{} numbers; must be 3: x, y and yaw", map.origin.size()));
  }
  if (context.Read("free_thresh") && context.Read("occupied_thresh") &&
      map.free_thresh > map.occupied_thresh) {
    context.AddError(
        NodeAt(root, "free_thresh").Mark(), "free_thresh",
        fmt::format("{} is above occupied_thresh, {}", map.free_thresh, map.occupied_thresh));
  }
  context.ThrowProblems();
  return map;
}

MapCell CellOf(const RosMapKeys& map, const MapImage& image, std::size_t pixel) {
  if (map.mode == MapMode::kScale && !image.opaque.empty() && image.opaque[pixel] == 0) {
    return MapCell::kUnknown;
  }
  const bool negate = map.negate == "1" || map.negate == "true";
  const double bright = static_cast<double>(image.gray[pixel]) / image.white;
  const double dark = negate ? bright : 1.0 - bright;
  return dark > map.occupied_thresh ? MapCell::kOccupied
         : dark < map.free_thresh   ? MapCell::kFree
                                    : MapCell::kUnknown;
}

/// Returns the path of the map's image file. The programs map_saver and Cartographer write absolute
/// paths, which other machines do not have. A missing file with an absolute path is replaced by the
/// file of the same name beside the map.
fs::path ImageFile(const fs::path& file, const std::string& image) {
  const fs::path named = file.parent_path() / image;
  std::error_code ignored;
  if (fs::path(image).is_relative() || fs::exists(named, ignored)) {
    return named;
  }
  const fs::path beside = file.parent_path() / named.filename();
  if (!fs::exists(beside, ignored)) {
    throw InputError(
        Problem{.file = file.string(),
                .key = "image",
                .message = fmt::format("{} does not exist, and there is no {} beside the map file",
                                       image, named.filename().string())});
  }
  return beside;
}

}  // namespace

GridMap ReadRosMap(const fs::path& file, const AccessCheck& access_error) {
  const RosMapKeys keys = ReadRosMapKeys(file);
  const fs::path image_file = ImageFile(file, keys.image);
  if (const std::string why = access_error ? access_error(image_file) : ""; !why.empty()) {
    throw InputError(Problem{
        .file = file.string(), .key = "image", .message = fmt::format("{} {}", keys.image, why)});
  }
  const MapImage image = ReadMapImage(ReadMapFile(image_file), image_file.string());
  GridMap map{.X_WM = {keys.origin[0], keys.origin[1], keys.origin[2]},
              .cell = keys.resolution,
              .columns = image.columns,
              .rows = image.rows,
              .cells = {}};
  map.cells.reserve(image.gray.size());
  const auto columns = static_cast<std::size_t>(image.columns);
  for (std::size_t row = static_cast<std::size_t>(image.rows); row-- > 0;) {
    for (std::size_t column = 0; column < columns; ++column) {
      map.cells.push_back(CellOf(keys, image, row * columns + column));
    }
  }
  return map;
}

bool IsRosMap(const fs::path& file) {
  try {
    const YAML::Node root = LoadYaml(ReadMapFile(file), file.string(), "a ROS map");
    return root["image"] && root["resolution"];
  } catch (const InputError&) {
    return false;
  }
}

MapObstacles ReadMap(const MapSpec& spec, const fs::path& folder, const AccessCheck& access_error) {
  const fs::path file = folder / spec.file;
  const bool is_moving_ai = IsMovingAiMap(file);
  if (is_moving_ai != spec.cell.has_value()) {
    throw InputError(Problem{
        .key = "world.map.cell",
        .message = is_moving_ai ? "missing; a .map file does not say how large its cells are"
                                : "not allowed with a ROS map, which has its own resolution"});
  }
  GridMap map = is_moving_ai ? ReadMovingAiMap(file, *spec.cell) : ReadRosMap(file, access_error);
  map.X_WM = {spec.x.value_or(map.X_WM.x), spec.y.value_or(map.X_WM.y),
              spec.yaw.value_or(map.X_WM.yaw)};
  MapObstacles obstacles(std::move(map), spec.unknown);
  if (obstacles.boxes().size() > kMaxWalls) {
    throw InputError(Problem{
        .file = file.string(),
        .message = fmt::format("its blocked cells merge into {} rectangular walls; must be at most "
                               "{}: use a coarser or less noisy map",
                               obstacles.boxes().size(), kMaxWalls)});
  }
  return obstacles;
}

std::string MapYaml(const GridMap& map) {
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, {}]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
      kMapPgm, map.cell, map.X_WM.x, map.X_WM.y, map.X_WM.yaw);
}

std::string MapPgm(const GridMap& map) {
  std::string pgm = fmt::format("P5\n{} {}\n255\n", map.columns, map.rows);
  pgm.reserve(pgm.size() + map.cells.size());
  for (int row = map.rows; row-- > 0;) {
    for (int column = 0; column < map.columns; ++column) {
      const MapCell cell = map.At(column, row);
      const int gray = cell == MapCell::kOccupied ? 0 : cell == MapCell::kFree ? 254 : 205;
      pgm.push_back(static_cast<char>(gray));
    }
  }
  return pgm;
}

}  // namespace trackbed
