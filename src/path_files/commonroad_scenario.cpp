#include "trackbed/path_files/commonroad_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "src/path_files/commonroad_obstacles.h"
#include "src/path_files/commonroad_problem.h"
#include "src/path_files/commonroad_xml.h"
#include "src/path_files/formats.h"
#include "src/path_files/lanelet_path.h"
#include "trackbed/core/angle.h"

// Reads a CommonRoad scenario. ReadPlanningProblem reads the planning problem, FindLaneletRoute
// finds lanelets from its start to its goal, and LaneletPath makes a path from them. ChooseSpeed
// then finds the speed at which a car meets the goal in time. The path ends where a car that brakes
// after the goal has stopped.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

constexpr double kAcceleration = kCommonRoadAcceleration;
constexpr double kMinSpeed = 0.1;   // Lowest speed of the car [m/s].
constexpr double kMaxSpeed = 60.0;  // Highest speed of the car [m/s].
constexpr double kMaxLength = 5e4;  // Largest length of a route [m].

/// Stations at which a path enters and leaves a region.
struct Passage {
  double from = 0.0;  // [m]
  double to = 0.0;    // [m]
};

std::vector<double> StationsOf(const std::vector<Vec2>& path) {
  std::vector<double> stations{0.0};
  for (std::size_t i = 1; i < path.size(); ++i) {
    stations.push_back(stations.back() + (path[i] - path[i - 1]).norm());
  }
  return stations;
}

std::optional<Passage> PassageOf(const std::vector<Vec2>& path,
                                 const std::vector<CommonRoadRegion>& regions) {
  const std::vector<double> stations = StationsOf(path);
  if (regions.empty()) {
    return Passage{0.0, stations.back()};
  }
  std::optional<Passage> passage;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool inside =
        std::any_of(regions.begin(), regions.end(),
                    [&](const CommonRoadRegion& region) { return region.Contains(path[i]); });
    if (inside) {
      passage = Passage{passage ? passage->from : stations[i], stations[i]};
    } else if (passage) {
      break;
    }
  }
  return passage;
}

/// Returns the distance that a car drives in a time, from one speed toward another.
double DrivenIn(double time, double from, double to) {
  const double change = std::abs(to - from) / kAcceleration;
  const double sign = to < from ? -1.0 : 1.0;
  const double changing = std::min(time, change);
  return from * changing + sign * 0.5 * kAcceleration * changing * changing +
         to * (time - changing);
}

/// Returns the speed nearest to the initial speed at which a car passes the goal in time. If no
/// speed reaches the goal in time, returns the speed at which the car misses the goal by the
/// shortest distance.
double ChooseSpeed(const PlanningProblem& problem, const Passage& passage) {
  const CommonRoadGoal& goal = problem.goal;
  const double margin = std::min(2.0, 0.25 * (passage.to - passage.from));
  double best = std::max(problem.speed, kMinSpeed);
  auto least = std::pair(std::numeric_limits<double>::infinity(), 0.0);
  const auto look = [&](double speed) {
    const double early = DrivenIn(goal.time.first, problem.speed, speed);
    const double late = DrivenIn(goal.time.second, problem.speed, speed);
    double miss = std::max({0.0, passage.from + margin - late, early - (passage.to - margin)});
    if (goal.speed) {
      miss += std::max({0.0, goal.speed->first - speed, speed - goal.speed->second});
    }
    const auto rank = std::pair(miss, std::abs(speed - problem.speed));
    if (rank < least) {
      least = rank;
      best = speed;
    }
  };
  look(best);
  for (double speed = kMinSpeed; speed <= kMaxSpeed; speed += 0.1) {
    look(speed);
  }
  return best;
}

/// Measures the road beside the route up to a station, and the route's heading there.
void MeasureRoute(const Lanelets& lanelets, double end, CommonRoadScenario& scenario) {
  constexpr double kMaxRoom = 8.0;  // [m]
  constexpr double kStep = 0.25;    // [m]
  const auto on_road = [&](const Vec2& point) {
    return std::any_of(lanelets.begin(), lanelets.end(),
                       [&](const auto& entry) { return entry.second.Contains(point); });
  };
  const std::vector<Vec2>& route = scenario.route;
  const std::vector<double> stations = StationsOf(route);
  double yaw = scenario.start.yaw;
  scenario.room_left = kMaxRoom;
  scenario.room_right = kMaxRoom;
  for (std::size_t i = 1; i < route.size() && stations[i] <= end; ++i) {
    const Vec2 step = route[i] - route[i - 1];
    yaw += AngleDifference(std::atan2(step.y(), step.x()), yaw);
    for (const auto& [room, side] :
         {std::pair(&scenario.room_left, 1.0), std::pair(&scenario.room_right, -1.0)}) {
      double free = 0.0;
      while (free < *room &&
             on_road(route[i] + side * (free + kStep) * LeftNormal(Direction(yaw)))) {
        free += kStep;
      }
      *room = std::min(*room, free);
    }
  }
  scenario.goal_yaw = yaw;
}

/// Cuts a path at a station.
void Cut(std::vector<Vec2>& path, double length) {
  const std::vector<double> stations = StationsOf(path);
  const auto end = std::lower_bound(stations.begin(), stations.end(), length) - stations.begin();
  path.resize(std::max<std::size_t>(3, std::min(path.size(), static_cast<std::size_t>(end) + 1)));
}

/// Finds the lanelets of the route. For a goal without a place, the route is the lanelet at the
/// start.
std::vector<LaneletLane> LanesOf(const PlanningProblem& problem, const Lanelets& lanelets,
                                 const CommonRoadReading& reading, int line) {
  const std::vector<std::string> starts = LaneletsAt(lanelets, problem.start);
  if (starts.empty()) {
    Refuse(reading.file, "initialState",
           fmt::format("the start ({:.6g}, {:.6g}) is in no lanelet with about the direction "
                       "{:.4g} rad, and more than 5 m from each",
                       problem.start.x, problem.start.y, problem.start.yaw),
           line);
  }
  if (problem.goal.regions.empty()) {
    return {{&lanelets.at(starts.front())}};
  }
  const std::vector<std::string> goals = GoalLanelets(problem, lanelets);
  if (goals.empty()) {
    Refuse(reading.file, "goalState", "the goal's region is in no lanelet", line);
  }
  auto lanes = FindLaneletRoute(lanelets, starts, goals);
  if (!lanes) {
    Refuse(reading.file, "goalState",
           fmt::format("no successors and lane changes lead from lanelet {} to lanelet {}; a route "
                       "follows the elements successor, adjacentLeft and adjacentRight of lanelets",
                       fmt::join(starts, " or "), fmt::join(goals, " or ")),
           line);
  }
  return *lanes;
}

/// Returns the origin of the coordinates: (0, 0) or, if the start is more than 50 km from (0, 0),
/// the nearest point at whole kilometers.
Vec2 OriginOf(const XMLElement& root, const std::filesystem::path& file) {
  constexpr double kFar = 5e4;          // [m]
  constexpr double kRounding = 1000.0;  // [m]
  const XMLElement* problem = root.FirstChildElement("planningProblem");
  const XMLElement* initial =
      problem == nullptr ? nullptr : problem->FirstChildElement("initialState");
  if (initial == nullptr) {
    return Vec2::Zero();
  }
  const Vec2 place = ReadPlace(*initial, {file, kMaxPosition}).position();
  if (place.cwiseAbs().maxCoeff() <= kFar) {
    return Vec2::Zero();
  }
  return kRounding * (place / kRounding).array().round().matrix();
}

/// Leaves out an obstacle that begins in the initial state, whether the obstacle stands or moves:
/// scenarios that are made from recordings may have the recorded car of the problem among their
/// obstacles.
void LeaveOutOwnCar(CommonRoadScenario& scenario) {
  constexpr double kSame = 1e-3;  // Pose tolerance [m, rad]; files have four decimals.
  const std::size_t left_out = std::erase_if(scenario.obstacles, [&](const auto& obstacle) {
    const Pose2& pose =
        obstacle.poses.empty() ? obstacle.box.center : obstacle.poses.front().second;
    return std::hypot(pose.x - scenario.start.x, pose.y - scenario.start.y) <= kSame &&
           std::abs(WrapAngle(pose.yaw - scenario.start.yaw)) <= kSame;
  });
  if (left_out > 0) {
    scenario.notes.emplace_back(
        "an obstacle that begins in the initial state is left out: it is the recorded car");
  }
}

/// Place of the planning problem in the file, for error messages.
struct ProblemPlace {
  const std::filesystem::path& file;
  int line;
};

/// Chooses the route and the speed of the scenario, and removes the regions of the goal that the
/// route does not pass.
void ChooseRoute(const PlanningProblem& problem, const Lanelets& lanelets,
                 const std::vector<LaneletLane>& lanes, const ProblemPlace& place,
                 CommonRoadScenario& scenario) {
  // Compute path and speed twice: the length of the path depends on the speed, and the speed
  // depends on the path.
  scenario.speed = std::max(problem.speed, kMinSpeed);
  for (int pass = 0; pass < 2; ++pass) {
    const double speed = std::max(scenario.speed, problem.speed);
    const double stop = speed * speed / (2.0 * kAcceleration) + 10.0;
    const double ahead = problem.goal.regions.empty() ? speed * problem.goal.time.second : 0.0;
    const bool has_aim = problem.goal_lanelets.empty() && problem.goal.regions.size() == 1;
    const auto aim = has_aim ? std::optional(MiddleOf(problem.goal.regions.front())) : std::nullopt;
    double length = stop + ahead;
    for (const LaneletLane& lane : lanes) {
      for (const Lanelet* lanelet : lane) {
        length += lanelet->Length();
      }
    }
    if (length > kMaxLength) {
      Refuse(place.file, "goalState",
             fmt::format("the route to the goal would be {:.4g} km long; must be at most {:.0f} km",
                         1e-3 * length, 1e-3 * kMaxLength),
             place.line);
    }
    scenario.route = LaneletPath(lanelets, lanes, problem.start, aim, speed, stop + ahead);
    const std::optional<Passage> passage = PassageOf(scenario.route, problem.goal.regions);
    if (!passage) {
      Refuse(place.file, "goalState", "the route along the lanelets does not pass through the goal",
             place.line);
    }
    scenario.speed = ChooseSpeed(problem, *passage);
    if (pass == 1) {
      const double latest = DrivenIn(problem.goal.time.second, problem.speed, scenario.speed);
      const double at_goal = std::max(passage->from, std::min(passage->to, latest));
      Cut(scenario.route, at_goal + stop);
      MeasureRoute(lanelets, at_goal, scenario);
      std::erase_if(scenario.goal.regions, [&](const CommonRoadRegion& region) {
        return std::none_of(scenario.route.begin(), scenario.route.end(),
                            [&](const Vec2& point) { return region.Contains(point); });
      });
    }
  }
}

}  // namespace

bool IsCommonRoadScenario(const std::string& text) {
  if (text.find('<') == std::string::npos || text.find("<commonRoad") == std::string::npos) {
    return false;
  }
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return begin != std::string::npos && text[begin] == '<';
}

CommonRoadScenario ReadCommonRoadScenario(const std::filesystem::path& file,
                                          const std::string& text) {
  tinyxml2::XMLDocument document;
  const XMLElement& root = ParseCommonRoadXml(document, text, file);
  if (std::string_view(root.Name()) != "commonRoad") {
    Refuse(file, "", fmt::format("the root element is {}; must be commonRoad", root.Name()),
           root.GetLineNum());
  }
  CommonRoadScenario scenario;
  const char* name = root.Attribute("benchmarkID");
  scenario.name = name == nullptr ? file.stem().string() : name;
  const double timestep = root.DoubleAttribute("timeStepSize", 0.0);
  if (!(timestep > 0.0 && timestep <= 100.0)) {
    Refuse(file, "timeStepSize", fmt::format("{} s; must be above 0 and at most 100 s", timestep),
           root.GetLineNum());
  }
  const CommonRoadReading reading{file, kMaxPosition, OriginOf(root, file)};
  if (reading.origin != Vec2::Zero()) {
    scenario.notes.push_back(fmt::format("all coordinates are relative to ({:.0f}, {:.0f})",
                                         reading.origin.x(), reading.origin.y()));
  }
  const Lanelets lanelets = ReadLanelets(root, reading);
  if (lanelets.empty()) {
    Refuse(file, "lanelet", "missing: the file has no roads", root.GetLineNum());
  }
  const PlanningProblem problem =
      ReadPlanningProblem(root, lanelets, timestep, reading, scenario.notes);
  scenario.start = problem.start;
  scenario.start_speed = problem.speed;
  scenario.goal = problem.goal;
  scenario.obstacles =
      ReadCommonRoadObstacles(root, {timestep, problem.start_step}, reading, scenario.notes);
  LeaveOutOwnCar(scenario);
  const int line = root.FirstChildElement("planningProblem")->GetLineNum();
  const std::vector<LaneletLane> lanes = LanesOf(problem, lanelets, reading, line);
  ChooseRoute(problem, lanelets, lanes, {file, line}, scenario);
  scenario.lanes = DrawnLanesOf(lanelets, scenario.route);
  if (root.FirstChildElement("environmentObstacle") != nullptr) {
    scenario.notes.emplace_back("environment obstacles, such as buildings, are not read");
  }
  if (root.FirstChildElement("trafficSign") != nullptr ||
      root.FirstChildElement("trafficLight") != nullptr) {
    scenario.notes.emplace_back("traffic signs and traffic lights are not read");
  }
  return scenario;
}

}  // namespace trackbed
