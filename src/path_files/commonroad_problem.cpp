#include "src/path_files/commonroad_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

using tinyxml2::XMLElement;

std::pair<double, double> PairOf(const CommonRoadInterval& interval, double factor = 1.0) {
  return {factor * interval.from, factor * interval.to};
}

/// Reads the region of a goal; returns its lanelets separately.
void ReadGoalPosition(const XMLElement& position, const Lanelets& lanelets,
                      const CommonRoadReading& reading, PlanningProblem& problem) {
  // Number of convex pieces into which a goal lanelet is divided.
  constexpr std::size_t kPieces = 6;
  for (const XMLElement* child = position.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()) == "lanelet") {
      const char* id = child->Attribute("ref");
      const auto found = id == nullptr ? lanelets.end() : lanelets.find(id);
      if (found == lanelets.end()) {
        Refuse(reading.file, "lanelet",
               fmt::format("the goal is in the lanelet {}, which is not in the file",
                           id == nullptr ? "without a number" : id),
               child->GetLineNum());
      }
      problem.goal_lanelets.push_back(found->first);
      for (CommonRoadRegion& region : RegionsOf(found->second, kPieces)) {
        problem.goal.regions.push_back(std::move(region));
      }
    } else {
      problem.goal.regions.push_back(ReadRegion(*child, reading));
    }
  }
}

/// Reads the time interval in which the car must reach the goal. For a goal with a position, the
/// file may omit the time.
void ReadGoalTime(const XMLElement& goal, double timestep, const CommonRoadReading& reading,
                  PlanningProblem& problem, std::vector<std::string>& notes) {
  constexpr double kMaxStep = 1e12;
  const auto time = IntervalOfChild(goal, "time", {reading.file, kMaxStep, reading.origin});
  if (!time && problem.goal.regions.empty()) {
    Refuse(reading.file, "goalState", "has neither a position nor a time; add one of them",
           goal.GetLineNum());
  }
  if (!time) {
    problem.goal.time = {0.0, std::numeric_limits<double>::infinity()};
    notes.emplace_back("goalState has no time: the goal may be reached at any time");
    return;
  }
  problem.goal.time = {std::max(0.0, timestep * (time->from - problem.start_step)),
                       timestep * (time->to - problem.start_step)};
  if (problem.goal.time.second <= 0.0) {
    Refuse(reading.file, "time", "the goal must be reached before the start", goal.GetLineNum());
  }
}

/// Returns the distance of a region's middle from its edge.
double InnerRadius(const CommonRoadRegion& region) {
  if (region.corners.empty()) {
    return region.radius;
  }
  std::vector<Vec2> edge = region.corners;
  edge.push_back(edge.front());
  return PlaceOn(edge, MiddleOf(region)).distance;
}

}  // namespace

PlanningProblem ReadPlanningProblem(const tinyxml2::XMLElement& root, const Lanelets& lanelets,
                                    double timestep, const CommonRoadReading& reading,
                                    std::vector<std::string>& notes) {
  const XMLElement* element = root.FirstChildElement("planningProblem");
  if (element == nullptr) {
    Refuse(
        reading.file, "planningProblem",
        "missing: the file describes a road and traffic, but neither start nor goal of a car; add "
        "a planningProblem with an initialState and a goalState",
        root.GetLineNum());
  }
  if (element->NextSiblingElement("planningProblem") != nullptr) {
    notes.emplace_back("several planning problems: the first is driven");
  }
  PlanningProblem problem;
  const XMLElement& initial = RequiredChild(*element, "initialState", reading);
  problem.start = ReadPlace(initial, reading);
  const auto middle = [&](const char* name, double missing) {
    const auto interval = IntervalOfChild(initial, name, reading);
    return interval ? interval->middle() : missing;
  };
  problem.start.yaw = middle("orientation", 0.0);
  problem.speed = std::abs(middle("velocity", 0.0));
  if (problem.speed > kMaxPathSpeed) {
    Refuse(reading.file, "velocity",
           fmt::format("{} m/s; must be at most {} m/s", problem.speed, kMaxPathSpeed),
           initial.GetLineNum());
  }
  problem.start_step = middle("time", 0.0);
  const XMLElement& goal = RequiredChild(*element, "goalState", reading);
  if (goal.NextSiblingElement("goalState") != nullptr) {
    notes.emplace_back("several goal states: the first is the goal");
  }
  if (const XMLElement* position = goal.FirstChildElement("position")) {
    ReadGoalPosition(*position, lanelets, reading, problem);
  }
  ReadGoalTime(goal, timestep, reading, problem, notes);
  if (const auto speed = IntervalOfChild(goal, "velocity", reading)) {
    problem.goal.speed = PairOf(*speed);
  }
  if (const auto yaw = IntervalOfChild(goal, "orientation", reading)) {
    problem.goal.orientation = PairOf(*yaw);
  }
  return problem;
}

Vec2 MiddleOf(const CommonRoadRegion& region) {
  Vec2 middle = region.center;
  if (!region.corners.empty()) {
    middle = Vec2::Zero();
    for (const Vec2& corner : region.corners) {
      middle += corner / static_cast<double>(region.corners.size());
    }
  }
  return middle;
}

std::vector<std::string> GoalLanelets(const PlanningProblem& problem, const Lanelets& lanelets) {
  std::vector<std::string> found = problem.goal_lanelets;
  if (!found.empty()) {
    return found;
  }
  std::vector<std::string> reached;
  for (const CommonRoadRegion& region : problem.goal.regions) {
    const Vec2 middle = MiddleOf(region);
    const double radius = InnerRadius(region);
    for (const auto& [id, lanelet] : lanelets) {
      const auto& yaw = problem.goal.orientation;
      const bool may_lead_there =
          !yaw || std::abs(AngleDifference(PlaceOn(lanelet.center, middle).yaw,
                                           0.5 * (yaw->first + yaw->second))) < 0.5 * kPi;
      if (may_lead_there && lanelet.Contains(middle)) {
        found.push_back(id);
      } else if (may_lead_there && std::min({PlaceOn(lanelet.left, middle).distance,
                                             PlaceOn(lanelet.right, middle).distance,
                                             PlaceOn(lanelet.center, middle).distance}) < radius) {
        reached.push_back(id);
      }
    }
  }
  return found.empty() ? reached : found;
}

bool CommonRoadRegion::Contains(const Vec2& point) const {
  if (corners.empty()) {
    return (point - center).norm() <= radius;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& from = corners[i];
    const Vec2& to = corners[(i + 1) % corners.size()];
    if (Cross(to - from, point - from) < 0.0) {
      return false;
    }
  }
  return true;
}

}  // namespace trackbed
