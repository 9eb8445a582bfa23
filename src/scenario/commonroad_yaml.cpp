#include "src/scenario/commonroad_yaml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/path_files/commonroad_scenario.h"

namespace trackbed {
namespace {

/// Height of all obstacles [m], because CommonRoad files specify no heights.
constexpr double kObstacleHeight = 1.5;

/// Returns the condition that the car's center is in a region, as a formula over the position of
/// the rear axle. The formula of the region assumes that the car's heading in the region is about
/// `yaw`.
std::string InRegion(const CommonRoadRegion& region, double yaw) {
  const Vec2 ahead = kCommonRoadCenterAhead * Direction(yaw);
  if (region.corners.empty()) {
    const Vec2 center = region.center - ahead;
    return fmt::format(
        "(x_m - {0:.4f}) * (x_m - {0:.4f}) + (y_m - {1:.4f}) * (y_m - {1:.4f}) <= "
        "{2:.4f}",
        center.x(), center.y(), region.radius * region.radius);
  }
  std::vector<std::string> sides;
  for (std::size_t i = 0; i < region.corners.size(); ++i) {
    const Vec2& from = region.corners[i];
    const Vec2 edge = region.corners[(i + 1) % region.corners.size()] - from;
    if (edge.norm() < 1e-6) {
      continue;
    }
    const Vec2 inward = LeftNormal(edge.normalized());
    sides.push_back(fmt::format("{:.6f} * x_m + {:.6f} * y_m >= {:.4f}", inward.x(), inward.y(),
                                inward.dot(from - ahead)));
  }
  return fmt::format("({})", fmt::join(sides, " and "));
}

/// Returns the goal of a CommonRoad scenario as a requirement formula over the log.
std::string GoalFormula(const CommonRoadScenario& scenario) {
  const CommonRoadGoal& goal = scenario.goal;
  std::vector<std::string> conditions;
  std::vector<std::string> places;
  for (const CommonRoadRegion& region : goal.regions) {
    places.push_back(InRegion(region, scenario.goal_yaw));
  }
  if (!places.empty()) {
    conditions.push_back(fmt::format("({})", fmt::join(places, " or ")));
  }
  if (goal.speed) {
    conditions.push_back(fmt::format("speed_mps >= {:.6g} and speed_mps <= {:.6g}",
                                     goal.speed->first, goal.speed->second));
  }
  if (goal.orientation) {
    // Use the goal's yaw interval that is nearest to the route's heading, and this interval shifted
    // by one turn in either direction. The heading of a plan begins between -pi and pi; the heading
    // of the initial state may differ by a whole turn.
    const double middle = 0.5 * (goal.orientation->first + goal.orientation->second);
    const double half = 0.5 * (goal.orientation->second - goal.orientation->first);
    const double yaw = scenario.goal_yaw + AngleDifference(middle, scenario.goal_yaw);
    std::vector<std::string> turns;
    for (const double turn : {0.0, -2.0 * kPi, 2.0 * kPi}) {
      turns.push_back(fmt::format("(yaw_rad >= {:.6f} and yaw_rad <= {:.6f})", yaw + turn - half,
                                  yaw + turn + half));
    }
    conditions.push_back(fmt::format("({})", fmt::join(turns, " or ")));
  }
  if (conditions.empty()) {
    conditions.emplace_back("t_s >= 0");
  }
  // The formula language rejects time bounds beyond kMaxTimeBound. If the goal's latest time is
  // beyond kMaxTimeBound, the formula has no time bounds, because no run takes so long.
  constexpr double kMaxTimeBound = 1e6;  // [s]
  const std::string interval =
      goal.time.second <= kMaxTimeBound
          ? fmt::format("[{:.6g}, {:.6g}]", goal.time.first, goal.time.second)
          : "";
  return fmt::format("eventually{} ({})", interval, fmt::join(conditions, " and "));
}

void EmitPose(YAML::Emitter& out, const Pose2& pose) {
  out << YAML::Key << "x" << YAML::Value << pose.x << YAML::Key << "y" << YAML::Value << pose.y
      << YAML::Key << "yaw" << YAML::Value << pose.yaw;
}

void EmitObstacle(YAML::Emitter& out, const CommonRoadObstacle& obstacle) {
  out << YAML::BeginMap << YAML::Key << "box" << YAML::Value << YAML::Flow << YAML::BeginMap;
  if (obstacle.poses.empty()) {
    EmitPose(out, obstacle.box.center);
  }
  out << YAML::Key << "length" << YAML::Value << obstacle.box.length << YAML::Key << "width"
      << YAML::Value << obstacle.box.width << YAML::Key << "height" << YAML::Value
      << kObstacleHeight << YAML::EndMap;
  if (!obstacle.poses.empty()) {
    out << YAML::Key << "motion" << YAML::Value << YAML::BeginSeq;
    double yaw = obstacle.poses.front().second.yaw;
    for (const auto& [time, pose] : obstacle.poses) {
      yaw += AngleDifference(pose.yaw, yaw);
      out << YAML::Flow << YAML::BeginMap << YAML::Key << "time" << YAML::Value << time;
      EmitPose(out, {pose.x, pose.y, yaw});
      out << YAML::EndMap;
    }
    out << YAML::EndSeq << YAML::Key << "until" << YAML::Value << obstacle.poses.back().first;
  }
  out << YAML::EndMap;
}

void EmitPlan(YAML::Emitter& out, const CommonRoadScenario& scenario, const std::string& file) {
  const bool replans = !scenario.obstacles.empty();
  out << YAML::Key << "plan" << YAML::Value << YAML::BeginMap;
  if (replans) {
    out << YAML::Key << "global" << YAML::Value << YAML::BeginMap;
  }
  out << YAML::Key << "method" << YAML::Value << "path_file" << YAML::Key << "file" << YAML::Value
      << file << YAML::Key << "format" << YAML::Value << "commonroad" << YAML::Key << "ahead"
      << YAML::Value << kCommonRoadCenterAhead << YAML::Key << "max_deviation" << YAML::Value
      << 0.1;
  if (replans) {
    out << YAML::EndMap << YAML::Key << "replan" << YAML::Value << YAML::BeginMap << YAML::Key
        << "period" << YAML::Value << 0.2 << YAML::Key << "look_ahead" << YAML::Value << 6.0
        << YAML::Key << "gap" << YAML::Value << 1.0 << YAML::Key << "time_gap" << YAML::Value << 0.5
        << YAML::Key << "safe_distance" << YAML::Value << 0.3 << YAML::Key << "road" << YAML::Value
        << YAML::Flow << YAML::BeginMap << YAML::Key << "left" << YAML::Value
        << std::max(1.0, scenario.room_left) << YAML::Key << "right" << YAML::Value
        << std::max(1.0, scenario.room_right) << YAML::EndMap << YAML::Key << "along" << YAML::Value
        << YAML::Flow << YAML::BeginMap << YAML::Key << "method" << YAML::Value << "frenet"
        << YAML::Key << "horizon" << YAML::Value << 4.0 << YAML::EndMap << YAML::EndMap;
  }
  out << YAML::EndMap;
}

}  // namespace

std::string CommonRoadYaml(const std::filesystem::path& file, const std::string& text) {
  const CommonRoadScenario scenario = ReadCommonRoadScenario(file, text);
  YAML::Emitter out;
  out.SetDoublePrecision(12);
  out << YAML::BeginMap << YAML::Key << "schema" << YAML::Value << 1 << YAML::Key << "name"
      << YAML::Value << YAML::DoubleQuoted << scenario.name;
  out << YAML::Key << "vehicle" << YAML::Value << YAML::BeginMap << YAML::Key << "model"
      << YAML::Value << "bmw320i" << YAML::EndMap;
  out << YAML::Key << "mission" << YAML::Value << YAML::BeginMap << YAML::Key << "speed"
      << YAML::Value << scenario.speed << YAML::Key << "start" << YAML::Value << YAML::Flow
      << YAML::BeginMap << YAML::Key << "speed" << YAML::Value << scenario.start_speed
      << YAML::EndMap << YAML::EndMap;
  if (!scenario.obstacles.empty()) {
    out << YAML::Key << "world" << YAML::Value << YAML::BeginMap << YAML::Key << "obstacles"
        << YAML::Value << YAML::BeginSeq;
    for (const CommonRoadObstacle& obstacle : scenario.obstacles) {
      EmitObstacle(out, obstacle);
    }
    out << YAML::EndSeq << YAML::EndMap;
  }
  EmitPlan(out, scenario, file.filename().string());
  out << YAML::Key << "control" << YAML::Value << YAML::BeginMap << YAML::Key << "method"
      << YAML::Value << "lqr" << YAML::Key << "speed" << YAML::Value << YAML::Flow << YAML::BeginMap
      << YAML::Key << "acceleration" << YAML::Value << kCommonRoadAcceleration << YAML::Key
      << "deceleration" << YAML::Value << kCommonRoadAcceleration << YAML::EndMap << YAML::EndMap;
  out << YAML::Key << "expect" << YAML::Value << YAML::BeginMap << YAML::Key << "collision"
      << YAML::Value << false << YAML::Key << "requirements" << YAML::Value << YAML::BeginSeq
      << YAML::BeginMap << YAML::Key << "name" << YAML::Value << "goal" << YAML::Key << "formula"
      << YAML::Value << YAML::DoubleQuoted << GoalFormula(scenario) << YAML::EndMap << YAML::EndSeq
      << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace trackbed
