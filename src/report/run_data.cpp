#include "src/report/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/report/checks.h"
#include "src/report/drive_data.h"
#include "src/report/numbers.h"
#include "src/report/paths.h"
#include "src/report/road_data.h"
#include "src/report/scene_data.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/road_look.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"
#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/report/names.h"
#include "trackbed/road_network/lane_paint.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/run_track.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/track/track_file.h"

// Reads the data of one run for a report page from the run folder: verdict and checks, world, plan,
// logs and metrics of each plant, and the resolved scenario. The logs of a run are thinned to a row
// limit (RowsToShow). The data of the 3D scene (vehicle, motion, ground) is added if all plants
// have state logs. Events and tyre forces of a run are added last, because they need the compiled
// model.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kMaxScenarioBytes = std::size_t{1} << 20U;

/// A column of a plant's log: the column's name in the page's data, its name in the log file, and
/// whether every log has the column.
struct Channel {
  const char* name;
  const char* column;
  bool needed;
};

constexpr std::array kChannels{
    Channel{"t", "t_s", true},
    Channel{"x", "x_m", true},
    Channel{"y", "y_m", true},
    Channel{"yaw", "yaw_rad", true},
    Channel{"speed", "speed_mps", true},
    Channel{"steering_command", "steering_command_rad", true},
    Channel{"steering", "steering_rad", true},
    Channel{"yaw_rate", "yaw_rate_radps", false},
    Channel{"lateral_acceleration", "lateral_acceleration_mps2", false},
    Channel{"cross_track", "cross_track_m", false},
    Channel{"heading_error", "heading_error_rad", false},
    Channel{"sideslip", "sideslip_rad", false},
    Channel{"longitudinal_acceleration", "longitudinal_acceleration_mps2", false},
    Channel{"clearance", "clearance_m", false},
    Channel{"hitch_angle", "hitch_angle_rad", false}};

/// Extends the bounding box with corners `low` and `high` such that it contains the points of a
/// line.
void Widen(const ordered_json& line, Vec2& low, Vec2& high) {
  for (const auto& [name, axis] : {std::pair{"x", 0}, std::pair{"y", 1}}) {
    for (const double value : line.at(name).get<std::vector<double>>()) {
      low[axis] = std::min(low[axis], value);
      high[axis] = std::max(high[axis], value);
    }
  }
}

/// Returns the x and y coordinates of a path at the given rows of its table.
ordered_json LineJson(const Table& table, const std::vector<std::size_t>& rows) {
  return {{"x", RoundedColumn(table, "x_m", rows)}, {"y", RoundedColumn(table, "y_m", rows)}};
}

ordered_json PlanLine(const fs::path& file) {
  // maximum number of rows of plan.csv that the page shows, enough for 2 km
  constexpr std::size_t kMaxRows = 20000;
  const Table table = ReadCsvExcerpt(file, {"x_m", "y_m"}).table;
  return LineJson(table, RowsToShow(table, kMaxRows));
}

/// Returns the plans adopted during the run, in the order of time, each with the time of adoption.
/// The points of the returned plans are thinned evenly to about 4000 points in total.
ordered_json NewPlans(const fs::path& file) {
  constexpr std::size_t kMaxPoints = 4000;
  const Table table = ReadCsvExcerpt(file, {"from_t_s", "x_m", "y_m"}).table;
  const std::vector<double> from = table.Column("from_t_s");
  const std::size_t step = from.size() / kMaxPoints + 1;
  ordered_json plans = ordered_json::array();
  for (std::size_t row = 0; row < from.size();) {
    std::vector<std::size_t> rows;
    const double begin = from[row];
    for (; row < from.size() && from[row] == begin; ++row) {
      if (rows.empty() || row % step == 0 || row + 1 == from.size() || from[row + 1] != begin) {
        rows.push_back(row);
      }
    }
    plans.push_back(LineJson(table, rows));
    plans.back()["from"] = Rounded(begin);
  }
  return plans;
}

ordered_json LogJson(const fs::path& file, std::size_t row_limit) {
  std::vector<std::string> needed;
  std::vector<std::string> optional;
  for (const Channel& channel : kChannels) {
    (channel.needed ? needed : optional).emplace_back(channel.column);
  }
  const CsvExcerpt log = ReadCsvExcerpt(run_folder::RequireFile(file), needed, optional);
  const std::vector<double> times = log.table.Column("t_s");
  if (times.empty()) {
    throw InputError(Problem{.file = file.string(), .message = "no rows"});
  }
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (!(times[row] > times[row - 1])) {
      throw InputError(
          Problem{file.string(), log.lines[row], 0, "t_s",
                  fmt::format("{} must be above the previous {}", times[row], times[row - 1])});
    }
  }
  const std::vector<std::size_t> rows = RowsToShow(log.table, row_limit);
  ordered_json json;
  for (const Channel& channel : kChannels) {
    if (log.table.Find(channel.column) >= 0) {
      json[channel.name] = RoundedColumn(log.table, channel.column, rows);
    }
  }
  return json;
}

/// Returns the end of a run as {status, t, s, cause}: status, time, station on the path, and cause.
ordered_json EndJson(const JsonValue& metrics) {
  ordered_json json{{"status", metrics.At("status").Text()}};
  for (const auto& [name, key] : {std::pair{"t", "status_t"}, std::pair{"s", "status_s"}}) {
    if (const std::optional<JsonValue> value = metrics.Find(key)) {
      json[name] = Rounded(value->Number());
    }
  }
  if (const std::optional<JsonValue> cause = metrics.Find("cause")) {
    json["cause"] = cause->Text();
  }
  return json;
}

ordered_json PlantJson(const fs::path& folder, const std::string& plant, const JsonValue& metrics,
                       std::size_t row_limit) {
  ordered_json json{{"name", plant},
                    {"end", EndJson(metrics)},
                    {"log", LogJson(folder / run_folder::LogCsv(plant), row_limit)}};
  if (const fs::path plans = folder / run_folder::NewPlansCsv(plant); fs::exists(plans)) {
    json["new_plans"] = NewPlans(run_folder::RequireFile(plans));
  }
  return json;
}

ordered_json BoxJson(const OrientedBox& box) {
  return {{"x", Rounded(box.center.x)},
          {"y", Rounded(box.center.y)},
          {"yaw", Rounded(box.center.yaw)},
          {"length", Rounded(box.length)},
          {"width", Rounded(box.width)}};
}

ordered_json WorldJson(const World& world) {
  ordered_json json{{"friction", Rounded(world.friction)},
                    {"obstacles", ordered_json::array()},
                    {"patches", ordered_json::array()}};
  for (const Obstacle& obstacle : world.obstacles) {
    ordered_json box = BoxJson(obstacle.footprint);
    const Vec2 velocity = MotionAt(obstacle, 0.0).velocity;
    box["vx"] = Rounded(velocity.x());
    box["vy"] = Rounded(velocity.y());
    if (obstacle.until) {
      box["until"] = Rounded(*obstacle.until);
    }
    for (const TimedPose& at : obstacle.motion) {
      box["motion"].push_back(
          {Rounded(at.time), Rounded(at.pose.x), Rounded(at.pose.y), Rounded(at.pose.yaw)});
    }
    box["height"] = Rounded(obstacle.height);
    box["known_later"] = obstacle.known_from_time || obstacle.known_from_range;
    json["obstacles"].push_back(box);
  }
  for (const FrictionPatch& patch : world.friction_patches) {
    json["patches"].push_back(BoxJson(patch.area));
    json["patches"].back()["friction"] = Rounded(patch.friction);
  }
  if (const std::vector<OrientedBox>& walls = MapWalls(world); !walls.empty()) {
    // All walls of the map have the same yaw angle, because they are aligned with the rows of the
    // map.
    json["walls"] = {{"yaw", Rounded(walls.front().center.yaw)},
                     {"height", Rounded(world.map->height)},
                     {"boxes", ordered_json::array()}};
    for (const OrientedBox& wall : walls) {
      json["walls"]["boxes"].push_back({Rounded(wall.center.x), Rounded(wall.center.y),
                                        Rounded(wall.length), Rounded(wall.width)});
    }
  }
  json["gusts"] = ordered_json::array();
  for (const Gust& gust : world.wind.gusts) {
    if (gust.area) {
      ordered_json area = BoxJson(*gust.area);
      area["from"] = Rounded(gust.from);
      if (gust.duration) {
        area["to"] = Rounded(gust.from + *gust.duration);
      }
      json["gusts"].push_back(area);
    }
  }
  return json;
}

ordered_json CarJson(const VehicleParams& car) {
  return {{"name", car.name},
          {"length", Rounded(car.length)},
          {"width", Rounded(car.width)},
          {"rear_overhang", Rounded(car.rear_overhang)},
          {"wheelbase", Rounded(car.wheelbase)},
          {"steering_limit", Rounded(car.steering_limit)},
          {"grip_acceleration", Rounded(car.friction_lateral * kGravity)}};
}

/// Returns the data of a run's plan: planning method, gates and path.
ordered_json PlanJson(const fs::path& folder) {
  const JsonValue file = ReadJson(folder / run_folder::kPlanJson);
  ordered_json plan{{"status", file.At("status").Text()}};
  for (const char* key : {"reason", "method"}) {
    if (const std::optional<JsonValue> text = file.Find(key)) {
      plan[key] = text->Text();
    }
  }
  for (const char* key : {"length_m", "duration_s"}) {
    if (const std::optional<JsonValue> number = file.Find(key)) {
      plan[key] = Rounded(number->Number());
    }
  }
  plan["cones"] = ordered_json::array();
  for (const std::vector<Vec2>& cones : GateCones(file)) {
    for (const Vec2& cone : cones) {
      plan["cones"].push_back({Rounded(cone.x()), Rounded(cone.y())});
    }
  }
  if (plan.at("status") == ToString(PlanStatus::kOk)) {
    plan["line"] = PlanLine(run_folder::RequireFile(folder / run_folder::kPlanCsv));
  }
  return plan;
}

/// Returns the two edge lines of a track, which have equal numbers of points.
ordered_json EdgesJson(const Track& track) {
  constexpr std::size_t kMaxPoints = 2000;
  const auto line = [&](const TrackEdgeLine& edge) {
    const std::size_t step = edge.size() / kMaxPoints + 1;
    ordered_json json{{"x", ordered_json::array()}, {"y", ordered_json::array()}};
    for (std::size_t i = 0; i < edge.size(); i += step) {
      json["x"].push_back(Rounded(edge[i].x()));
      json["y"].push_back(Rounded(edge[i].y()));
    }
    return json;
  };
  return {{"left", line(track.left_edge())}, {"right", line(track.right_edge())}};
}

/// Adds the data of the 3D scene if all plants have state logs.
void AddScene(const fs::path& folder, const World& world, std::size_t row_limit,
              ordered_json& run) {
  for (const ordered_json& plant : run["plants"]) {
    if (!fs::exists(folder / run_folder::StateCsv(plant.at("name").get<std::string>()))) {
      return;
    }
  }
  const ordered_json vehicle = VehicleJson(folder / run_folder::kModelXml);
  Vec2 low = Vec2::Zero();
  Vec2 high = Vec2::Zero();
  if (run.contains("plan") && run["plan"].contains("line")) {
    Widen(run["plan"]["line"], low, high);
  }
  for (ordered_json& plant : run["plants"]) {
    plant["motion"] = MotionJson(folder / run_folder::StateCsv(plant.at("name").get<std::string>()),
                                 vehicle, world, row_limit);
    Widen(plant["log"], low, high);
  }
  run["vehicle"] = vehicle;
  run["ground"] = GroundJson(world, low.x(), low.y(), high.x(), high.y());
}

/// Adds the report data that can be computed only with the compiled model of the car.
void AddCar(const fs::path& folder, const World& world, std::size_t row_limit, ordered_json& run) {
  const fs::path model = folder / run_folder::kModelXml;
  const CarModel car(ComposeScene(run_folder::RequireFile(model), {}), model.string());
  const TyreLaw law = ReadVehicleSpec(folder / run_folder::kScenarioYaml).tyre;
  run["car"] = CarJson(car.params());
  if (car.trailer()) {
    const TrailerParams& trailer = car.trailer()->params;
    run["car"]["trailer"] = {{"hitch", Rounded(trailer.hitch)},
                             {"tongue", Rounded(trailer.tongue)},
                             {"length", Rounded(trailer.length)},
                             {"width", Rounded(trailer.width)},
                             {"body_ahead", Rounded(trailer.body_ahead)}};
  }
  for (ordered_json& plant : run["plants"]) {
    const auto name = plant.at("name").get<std::string>();
    const fs::path log = folder / run_folder::LogCsv(name);
    plant["events"] = EventsJson(log, world, car.params());
    if (plant.contains("motion")) {
      plant["tyres"] = TyresJson(log, name, law, world, car, row_limit);
    }
  }
}

}  // namespace

const char* ColumnOfChannel(const std::string& name) {
  const auto* found = std::find_if(kChannels.begin(), kChannels.end(),
                                   [&](const Channel& channel) { return name == channel.name; });
  TRACKBED_CHECK(found != kChannels.end(), "no channel '{}'", name);
  return found->column;
}

bool IsRunFolder(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / run_folder::kMetricsJson, ignored);
}

bool IsComplete(const fs::path& folder) {
  return ReadJson(folder / run_folder::kMetricsJson).At("complete").Flag();
}

std::size_t PlantCount(const fs::path& folder) {
  return ReadJson(folder / run_folder::kMetricsJson).At("plants").Members().size();
}

namespace {

/// Adds the run's world and its plan to `run`, and returns the world.
World AddWorldAndPlan(const fs::path& folder, const fs::path& scenario, ordered_json& run) {
  for (const char* map : {kMapYaml, kMapPgm}) {
    if (fs::exists(folder / map)) {
      run_folder::RequireFile(folder / map);
    }
  }
  World world = ReadWorld(scenario);
  run["world"] = WorldJson(world);
  if (world.road_network) {
    const fs::path file = run_folder::RequireFile(folder / kRoadNetworkXodr);
    const auto& read = world.road_network->data;
    run["world"]["roads"] = RoadsJson(read ? read->network : ReadOpenDrive(file));
  }
  const bool has_lanes = fs::exists(folder / kLanesCsv);
  if (has_lanes) {
    run["world"]["roads"] =
        RoadsJson(PaintLanes(ReadLanesCsv(run_folder::RequireFile(folder / kLanesCsv))));
  }
  if (fs::exists(folder / run_folder::kPlanJson) || fs::exists(folder / run_folder::kPlanCsv)) {
    run["plan"] = PlanJson(folder);
    const auto road = RoadToDraw(world, run["plan"].value("method", ""));
    if (road && !has_lanes) {
      run["plan"]["road"] = {{"width", Rounded(road->width)}, {"lanes", road->lanes}};
    }
    if (const fs::path track = folder / kTrackCsv; fs::exists(track)) {
      run["plan"]["edges"] = EdgesJson(ReadRunTrack(run_folder::RequireFile(track), scenario));
    }
  }
  return world;
}

/// Returns the text values in a section of a JSON file, keyed by name.
ordered_json TextsJson(const JsonValue& section) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, text] : section.Members()) {
    json[name] = text.Text();
  }
  return json;
}

}  // namespace

ordered_json RunData(const fs::path& folder, const std::string& name, std::size_t row_limit) {
  const fs::path scenario = run_folder::RequireFile(folder / run_folder::kScenarioYaml);
  const JsonValue metrics = ReadJson(folder / run_folder::kMetricsJson);
  constexpr auto kMaxSeed = std::numeric_limits<std::uint64_t>::max();
  ordered_json run{{"name", name},
                   {"scenario", metrics.At("scenario").Text()},
                   {"complete", metrics.At("complete").Flag()},
                   {"seed", metrics.At("seed").Count(kMaxSeed)},
                   {"versions", TextsJson(metrics.At("versions"))},
                   {"verdict", VerdictJson(metrics.At("verdict"))}};
  run["expectations"] = CheckRows(metrics.At("verdict"));
  const World world = AddWorldAndPlan(folder, scenario, run);
  run["plants"] = ordered_json::array();
  for (const auto& [plant, entry] : metrics.At("plants").Members()) {
    run["plants"].push_back(PlantJson(folder, plant, entry, row_limit));
    run["plants"].back()["numbers"] = NumbersJson(entry.json(), NameOfMetric);
  }
  run["between"] = ordered_json::array();
  for (const JsonValue& pair : metrics.At("between").Elements()) {
    const std::vector<std::string> plants = pair.At("plants").Texts();
    ordered_json numbers = pair.json();
    numbers.erase("plants");
    run["between"].push_back(
        {{"plants", plants}, {"numbers", NumbersJson(numbers, NameOfComparison)}});
  }
  run["resolved"] = ReadFile(scenario, kMaxScenarioBytes);
  AddScene(folder, world, row_limit / 2, run);
  // the data of the car is added last, because computing this data takes the longest time
  AddCar(folder, world, row_limit / 2, run);
  return run;
}

}  // namespace trackbed
