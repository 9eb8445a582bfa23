#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "src/path_files/commonroad_xml.h"
#include "src/path_files/formats.h"
#include "trackbed/path_files/commonroad_scenario.h"

// Reads the path of a CommonRoad file. A solution contains one trajectory for each planning
// problem; a trajectory is a list of states. Velocities are negative in reverse. The path of a
// scenario is the route of its planning problem along lanelets.
namespace trackbed {
namespace {

/// Returns the route of the scenario as a path.
PathFile RouteOfScenario(const CommonRoadScenario& scenario) {
  PathFile found;
  found.points.points = scenario.route;
  found.notes = scenario.notes;
  return found;
}

using tinyxml2::XMLElement;

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

/// Takes the directions of motion from the velocities, which are signed in CommonRoad. Without a
/// negative velocity, the car drives forwards all along, whatever its orientations say.
void TakeVelocities(PathPoints& points) {
  TakeSignedSpeeds(points);
  if (points.direction.empty() && !points.yaw.empty() && !points.speed.empty()) {
    points.direction.assign(points.points.size(), 1);
  }
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
  for (const XMLElement* state = trajectory->FirstChildElement(); state != nullptr;
       state = state->NextSiblingElement()) {
    points.points.push_back(PointIn(*state, position));
    points.lines.push_back(state->GetLineNum());
    // A state of the point-mass model has velocities along both axes instead of an orientation.
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
  return found;
}

}  // namespace trackbed
