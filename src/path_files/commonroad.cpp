#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "src/path_files/commonroad_xml.h"
#include "src/path_files/formats.h"
#include "trackbed/path/tractrix.h"
#include "trackbed/path_files/commonroad_scenario.h"

// Reads the path of a CommonRoad file. A solution contains one trajectory for each planning
// problem; a trajectory is a list of states. The velocities of a trajectory are negative in
// reverse. The path of a scenario is the route of its planning problem along lanelets.
namespace trackbed {
namespace {

/// Returns the route of the scenario as a path. The headings are those of a car that starts with
/// the heading of the initial state.
PathFile RouteOfScenario(const CommonRoadScenario& scenario) {
  PathFile found;
  found.points.points = scenario.route;
  double yaw = scenario.start.yaw;
  for (std::size_t i = 0; i < scenario.route.size(); ++i) {
    if (i > 0) {
      yaw =
          YawAlongTractrix(yaw, scenario.route[i] - scenario.route[i - 1], kCommonRoadCenterAhead);
    }
    found.points.yaw.push_back(yaw);
  }
  found.points.direction.assign(scenario.route.size(), 1);
  found.notes = scenario.notes;
  found.lanes = scenario.lanes;
  return found;
}

using tinyxml2::XMLElement;

/// Largest accepted magnitude of a time step's number. Time steps with larger numbers are ignored.
constexpr double kMaxTimeStep = 1e9;

/// Returns the first XML element that contains a trajectory, such as the element ksTrajectory.
const XMLElement* FindTrajectory(const XMLElement& root, std::size_t& count) {
  const XMLElement* first = nullptr;
  for (const XMLElement* child = root.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()).ends_with("Trajectory")) {
      ++count;
      first = first == nullptr ? child : first;
    }
  }
  return first;
}

/// Sets the directions of motion from the velocities, which are negative in reverse in CommonRoad.
/// If no velocity is negative, the car drives forwards on the whole path, regardless of its
/// orientations.
void TakeVelocities(PathPoints& points) {
  TakeSignedSpeeds(points);
  if (points.direction.empty() && !points.yaw.empty() && !points.speed.empty()) {
    points.direction.assign(points.points.size(), 1);
  }
}

/// Converts the times of the states, which are numbers of time steps, to seconds. A solution does
/// not contain the duration of a time step, so the duration is computed from the positions and
/// velocities.
void TakeTimeSteps(PathFile& found, std::vector<double> steps, const std::string& file) {
  const PathPoints& points = found.points;
  const bool is_rising =
      std::adjacent_find(steps.begin(), steps.end(), std::greater_equal<>()) == steps.end();
  if (!is_rising || steps.size() != points.points.size() || steps.size() != points.speed.size()) {
    return;
  }
  double length = 0.0;
  double steps_times_speed = 0.0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    length += (points.points[i + 1] - points.points[i]).norm();
    steps_times_speed += 0.5 * (points.speed[i] + points.speed[i + 1]) * (steps[i + 1] - steps[i]);
  }
  // Round the duration of a time step to milliseconds, because the integral of the velocities is
  // not exact.
  const double duration = std::round(1e3 * length / steps_times_speed) * 1e-3;
  if (!(steps_times_speed > 0.0) || !(duration > 0.0)) {
    return;
  }
  for (double& step : steps) {
    step *= duration;
  }
  found.notes.push_back(
      fmt::format("time steps of {:.4g} s, computed from positions and velocities", duration));
  TakeTimes(found, std::move(steps), file);
}

}  // namespace

PathFile ReadCommonRoad(const std::filesystem::path& path, const std::string& text) {
  const std::string file = path.string();
  tinyxml2::XMLDocument document;
  const XMLElement& root = ParseCommonRoadXml(document, text, path);
  if (std::string_view(root.Name()) == "commonRoad") {
    return RouteOfScenario(ReadCommonRoadScenario(path, text));
  }
  if (std::string_view(root.Name()) != "CommonRoadSolution") {
    Refuse(file, "",
           fmt::format("the root element is {}; must be CommonRoadSolution or commonRoad",
                       root.Name()),
           root.GetLineNum());
  }
  std::size_t trajectories = 0;
  const XMLElement* trajectory = FindTrajectory(root, trajectories);
  if (trajectory == nullptr) {
    Refuse(file, "", "has no trajectory, such as ksTrajectory", root.GetLineNum());
  }
  const CommonRoadReading position{path, kMaxPosition};
  const CommonRoadReading velocity{path, kMaxPathSpeed};
  PathFile found;
  PathPoints& points = found.points;
  std::vector<double> steps;
  for (const XMLElement* state = trajectory->FirstChildElement(); state != nullptr;
       state = state->NextSiblingElement()) {
    points.points.push_back(PointIn(*state, position));
    points.lines.push_back(state->GetLineNum());
    const XMLElement* time = state->FirstChildElement("time");
    if (double step = 0.0; time != nullptr &&
                           time->QueryDoubleText(&step) == tinyxml2::XML_SUCCESS &&
                           std::abs(step) <= kMaxTimeStep) {
      steps.push_back(step);
    }
    // In CommonRoad's point-mass model, a state has velocities along both axes instead of an
    // orientation.
    const auto vx = NumberOfChild(*state, "xVelocity", velocity);
    const auto vy = NumberOfChild(*state, "yVelocity", velocity);
    const auto speed = NumberOfChild(*state, "velocity", velocity);
    if (const auto yaw = NumberOfChild(*state, "orientation", {path, 1e6})) {
      points.yaw.push_back(*yaw);
    }
    if (speed) {
      points.speed.push_back(*speed);
    } else if (vx && vy) {
      points.speed.push_back(std::min(std::hypot(*vx, *vy), kMaxPathSpeed));
    }
  }
  for (const auto& [list, name] :
       {std::pair(&points.yaw, "orientation"), std::pair(&points.speed, "velocity")}) {
    if (!list->empty() && list->size() != points.points.size()) {
      Refuse(file, name,
             fmt::format("in {} of {} states; must be in all or none", list->size(),
                         points.points.size()),
             trajectory->GetLineNum());
    }
  }
  TakeVelocities(points);
  found.notes.push_back(fmt::format(
      "CommonRoad {} of {} states{}", trajectory->Name(), points.points.size(),
      trajectories > 1 ? fmt::format(", the first of {}", trajectories) : std::string()));
  TakeTimeSteps(found, std::move(steps), file);
  return found;
}

}  // namespace trackbed
