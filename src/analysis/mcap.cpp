#include "trackbed/analysis/mcap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/analysis/mcap_writer.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

using nlohmann::json;

json Object(const json& properties) {
  return {{"type", "object"}, {"properties", properties}};
}
const json kNumber{{"type", "number"}};
const json kText{{"type", "string"}};

json ArraySchema(const json& items) {
  return {{"type", "array"}, {"items", items}};
}

// JSON schemas of Foxglove messages, reduced to the fields that Trackbed sets.
const json kTime = Object({{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}});
const json kVector = Object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
const json kQuaternion = Object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});
const json kPose = Object({{"position", kVector}, {"orientation", kQuaternion}});
const json kColor = Object({{"r", kNumber}, {"g", kNumber}, {"b", kNumber}, {"a", kNumber}});
const json kTransform = Object({{"timestamp", kTime},
                                {"parent_frame_id", kText},
                                {"child_frame_id", kText},
                                {"translation", kVector},
                                {"rotation", kQuaternion}});
const json kPoses =
    Object({{"timestamp", kTime}, {"frame_id", kText}, {"poses", ArraySchema(kPose)}});
const json kScene = Object(
    {{"entities",
      ArraySchema(Object(
          {{"timestamp", kTime},
           {"frame_id", kText},
           {"id", kText},
           {"lifetime", kTime},
           {"frame_locked", {{"type", "boolean"}}},
           {"cubes",
            ArraySchema(Object({{"pose", kPose}, {"size", kVector}, {"color", kColor}}))}}))}});

json Time(double time) {
  const auto nanoseconds = std::llround(time * 1e9);
  return {{"sec", nanoseconds / 1000000000}, {"nsec", nanoseconds % 1000000000}};
}

json Rotation(double yaw) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(0.5 * yaw)}, {"w", std::cos(0.5 * yaw)}};
}

json Pose(const Pose2& pose, double z) {
  return {{"position", {{"x", pose.x}, {"y", pose.y}, {"z", z}}},
          {"orientation", Rotation(pose.yaw)}};
}

json CubeAt(const OrientedBox& box, double height, const json& color) {
  return {{"pose", Pose(box.center, 0.5 * height)},
          {"size", {{"x", box.length}, {"y", box.width}, {"z", height}}},
          {"color", color}};
}

json Cube(const OrientedBox& box, double height, const std::string& id, const std::string& frame,
          double time, const json& color) {
  return {{"timestamp", Time(time)},
          {"frame_id", frame},
          {"id", id},
          // Lifetime 0: the viewer shows the entity until a new message replaces the entity.
          {"lifetime", Time(0.0)},
          {"frame_locked", true},
          {"cubes", json::array({CubeAt(box, height, color)})}};
}

json Obstacles(const World& world, double time) {
  json entities = json::array();
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    entities.push_back(Cube(FootprintAt(world.obstacles[i], time), world.obstacles[i].height,
                            fmt::format("obstacle_{}", i), "world", time,
                            {{"r", 0.75}, {"g", 0.1}, {"b", 0.15}, {"a", 1.0}}));
  }
  return {{"entities", entities}};
}

/// Returns the static walls of the world's map as a single scene entity with many cubes.
json Walls(const World& world) {
  json entity{{"timestamp", Time(0.0)},
              {"frame_id", "world"},
              {"id", "map"},
              // Lifetime 0: the viewer shows the entity until a new message replaces the entity.
              {"lifetime", Time(0.0)},
              {"frame_locked", true},
              {"cubes", json::array()}};
  for (const OrientedBox& wall : MapWalls(world)) {
    entity["cubes"].push_back(
        CubeAt(wall, world.map->height, {{"r", 0.62}, {"g", 0.6}, {"b", 0.57}, {"a", 1.0}}));
  }
  return {{"entities", json::array({entity})}};
}

json PosesMessage(const Path& path, double time) {
  constexpr double kSpacing = 0.5;  // [m]
  json poses = json::array();
  for (const PathPoint& point : path.Sample(kSpacing)) {
    poses.push_back(Pose(point.pose, 0.0));
  }
  return {{"timestamp", Time(time)}, {"frame_id", "world"}, {"poses", poses}};
}

/// Returns the Foxglove message with the pose of the coordinate frame `frame` in the world.
json Transform(double time, const std::string& frame, const Pose2& pose) {
  return {{"timestamp", Time(time)},
          {"parent_frame_id", "world"},
          {"child_frame_id", frame},
          {"translation", {{"x", pose.x}, {"y", pose.y}, {"z", 0.0}}},
          {"rotation", Rotation(pose.yaw)}};
}

/// A message and its time; messages are sorted by time.
struct Message {
  double time;
  std::uint16_t channel;
  json content;
};

void AddPlant(const RunResult& result, const RunLog& log, McapWriter& writer,
              std::vector<Message>& messages) {
  const VehicleParams& vehicle = result.vehicle;
  const std::string topic = "/" + log.plant + "/";
  const Table table = ToTable(log);
  json columns = json::object();
  for (const std::string& column : table.columns()) {
    columns[column] = kNumber;
  }
  const auto tf = writer.AddChannel(topic + "tf", "foxglove.FrameTransform", kTransform);
  const auto rows = writer.AddChannel(topic + "log", "trackbed.Log", Object(columns));
  const auto footprint = writer.AddChannel(topic + "footprint", "foxglove.SceneUpdate", kScene);
  messages.push_back({0.0,
                      footprint,
                      {{"entities",
                        {Cube(FootprintAt(vehicle, {}), vehicle.height, log.plant, log.plant, 0.0,
                              {{"r", 0.2}, {"g", 0.45}, {"b", 0.8}, {"a", 0.8}})}}}});
  const std::string towed = log.plant + "_trailer";
  if (log.trailer) {
    messages.push_back(
        {0.0,
         footprint,
         {{"entities",
           {Cube(TrailerFootprint(*log.trailer, {}), log.trailer->height, towed, towed, 0.0,
                 {{"r", 0.6}, {"g", 0.62}, {"b", 0.65}, {"a", 0.8}})}}}});
  }
  if (result.scenario.plan) {
    const auto plan = writer.AddChannel(topic + "plan", "foxglove.PosesInFrame", kPoses);
    messages.push_back({0.0, plan, PosesMessage(result.plan->reference.path, 0.0)});
    for (const PlanChange& change : log.changes) {
      messages.push_back(
          {change.time, plan, PosesMessage(change.plan.reference.path, change.time)});
    }
  }
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const VehicleState& state = log.rows[i].state;
    messages.push_back({state.time, tf, Transform(state.time, log.plant, state.pose)});
    if (log.trailer && log.rows[i].trailer) {
      const Pose2 axle = TrailerPose(*log.trailer, state.pose, log.rows[i].trailer->angle);
      messages.push_back({state.time, tf, Transform(state.time, towed, axle)});
    }
    json row = json::object();
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
      row[table.columns()[column]] = table.at(i, column);
    }
    messages.push_back({state.time, rows, std::move(row)});
  }
}

}  // namespace

std::string ToMcap(const RunResult& result) {
  const World& world = result.scenario.world;
  McapWriter writer;
  std::vector<Message> messages;
  double end = 0.0;
  for (const RunLog& log : result.logs) {
    AddPlant(result, log, writer, messages);
    end = std::max(end, log.rows.back().state.time);
  }
  if (!world.obstacles.empty()) {
    const auto obstacles = writer.AddChannel("/obstacles", "foxglove.SceneUpdate", kScene);
    const bool moves = std::any_of(world.obstacles.begin(), world.obstacles.end(),
                                   [](const Obstacle& obstacle) { return obstacle.moves(); });
    const int updates = moves ? static_cast<int>(end / 0.1) : 0;
    for (int i = 0; i <= updates; ++i) {
      messages.push_back({0.1 * i, obstacles, Obstacles(world, 0.1 * i)});
    }
  }
  if (!MapWalls(world).empty()) {
    const auto map = writer.AddChannel("/map", "foxglove.SceneUpdate", kScene);
    messages.push_back({0.0, map, Walls(world)});
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const Message& a, const Message& b) { return a.time < b.time; });
  for (const Message& message : messages) {
    writer.AddMessage(message.channel, message.time, message.content);
  }
  return writer.Finish();
}

}  // namespace trackbed
