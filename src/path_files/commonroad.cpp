#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "src/path_files/formats.h"
#include "trackbed/core/text_table.h"

// Reads CommonRoad solution files, which contain one trajectory for each planning problem; a
// trajectory is a list of states. Velocities are negative in reverse.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

std::optional<double> Number(const XMLElement& state, const char* name, double largest,
                             const std::string& file) {
  const XMLElement* element = state.FirstChildElement(name);
  if (element == nullptr) {
    return std::nullopt;
  }
  const char* text = element->GetText();
  std::string trimmed = text == nullptr ? "" : text;
  trimmed.erase(0, std::min(trimmed.find_first_not_of(" \t\r\n"), trimmed.size()));
  trimmed.erase(trimmed.find_last_not_of(" \t\r\n") + 1);
  const std::optional<double> number = CellNumber(trimmed);
  if (!number) {
    Refuse(file, name, fmt::format("'{}' is not a finite number", trimmed.substr(0, 40)),
           element->GetLineNum());
  }
  if (std::abs(*number) > largest) {
    Refuse(file, name,
           fmt::format("{} is out of range; must be between {} and {}", *number, -largest, largest),
           element->GetLineNum());
  }
  return number;
}

double Required(const XMLElement& state, const char* name, double largest,
                const std::string& file) {
  const std::optional<double> number = Number(state, name, largest, file);
  if (!number) {
    Refuse(file, name, fmt::format("missing in {}", state.Name()), state.GetLineNum());
  }
  return *number;
}

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
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    Refuse(file, "", fmt::format("not XML: {}", document.ErrorName()), document.ErrorLineNum());
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "CommonRoadSolution") {
    Refuse(file, "",
           fmt::format("the root element is {}; must be CommonRoadSolution",
                       root == nullptr ? "missing" : root->Name()),
           root == nullptr ? 1 : root->GetLineNum());
  }
  std::size_t trajectories = 0;
  const XMLElement* trajectory = FindTrajectory(*root, trajectories);
  if (trajectory == nullptr) {
    Refuse(file, "", "has no trajectory, such as ksTrajectory", root->GetLineNum());
  }
  PathFile found;
  PathPoints& points = found.points;
  for (const XMLElement* state = trajectory->FirstChildElement(); state != nullptr;
       state = state->NextSiblingElement()) {
    points.points.emplace_back(Required(*state, "x", kMaxPosition, file),
                               Required(*state, "y", kMaxPosition, file));
    points.lines.push_back(state->GetLineNum());
    // A state of the point-mass model has velocities along both axes instead of an orientation.
    const auto vx = Number(*state, "xVelocity", kMaxPathSpeed, file);
    const auto vy = Number(*state, "yVelocity", kMaxPathSpeed, file);
    const auto speed = Number(*state, "velocity", kMaxPathSpeed, file);
    if (const auto yaw = Number(*state, "orientation", 1e6, file)) {
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
