#include "src/path_files/commonroad_obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"

// Reads obstacles and goal regions of CommonRoad scenarios.
// 1. The shape of an obstacle is replaced by the smallest enclosing rectangle with a side along an
//    edge of the shape.
// 2. A moving obstacle has the poses of its trajectory. Without a trajectory, a moving obstacle
//    keeps its velocity.
// 3. A state without an orientation gets the direction of motion as its heading.
// 4. An occupancy set (places that an obstacle may occupy) is replaced by moving boxes, each as
//    large as the smallest place of the set. The moving boxes spread out as the possible places
//    grow. A place of the occupancy set is assumed at the middle of its time interval.
// 5. The struct Approximations counts the replacements of steps 1 to 4, for the notes to the user.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

/// Returns the smallest rectangle around points with one side along an edge of their polygon.
OrientedBox EnclosingBox(const std::vector<Vec2>& points) {
  OrientedBox best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 edge = points[(i + 1) % points.size()] - points[i];
    const double yaw = std::atan2(edge.y(), edge.x());
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
    Vec2 high = -low;
    for (const Vec2& point : points) {
      const Vec2 own = ToLocal({0.0, 0.0, yaw}, point);
      low = low.cwiseMin(own);
      high = high.cwiseMax(own);
    }
    const Vec2 size = high - low;
    if (size.x() * size.y() < least) {
      least = size.x() * size.y();
      const Vec2 center = ToWorld({0.0, 0.0, yaw}, 0.5 * (low + high));
      best = {{center.x(), center.y(), yaw}, size.x(), size.y()};
    }
  }
  return best;
}

/// A shape in the frame of its obstacle, and whether the box is larger than the shape.
struct Shape {
  OrientedBox box;
  bool is_larger = false;
};

Shape ReadShape(const XMLElement& shape, const CommonRoadReading& reading) {
  const std::string_view name = shape.Name();
  const XMLElement* at = shape.FirstChildElement("center");
  const Vec2 center = at == nullptr ? Vec2(-reading.origin) : PointIn(*at, reading);
  const auto positive = [&](const char* key) {
    const double size = RequiredNumber(shape, key, reading);
    if (!(size > 0.0)) {
      Refuse(reading.file, key, fmt::format("{} m; must be above 0", size), shape.GetLineNum());
    }
    return size;
  };
  if (name == "rectangle") {
    const auto yaw = IntervalOfChild(shape, "orientation", reading);
    return {{{center.x(), center.y(), yaw ? yaw->middle() : 0.0},
             positive("length"),
             positive("width")}};
  }
  if (name == "circle") {
    const double size = 2.0 * positive("radius");
    return {{{center.x(), center.y(), 0.0}, size, size}, true};
  }
  if (name != "polygon") {
    Refuse(reading.file, "shape",
           fmt::format("a {} is not read; must be rectangle, circle or polygon", name),
           shape.GetLineNum());
  }
  std::vector<Vec2> points;
  for (const XMLElement* point = shape.FirstChildElement("point"); point != nullptr;
       point = point->NextSiblingElement("point")) {
    points.push_back(PointIn(*point, reading));
  }
  const OrientedBox box = points.size() < 3 ? OrientedBox{} : EnclosingBox(points);
  if (!(box.length > 0.0 && box.width > 0.0)) {
    Refuse(reading.file, "polygon", "has no area", shape.GetLineNum());
  }
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    area += 0.5 * Cross(points[i], points[(i + 1) % points.size()]);
  }
  return {box, std::abs(area) < 0.99 * box.length * box.width};
}

/// Reads all shapes of an obstacle and returns one box around them.
Shape ReadShapes(const XMLElement& parent, const CommonRoadReading& reading) {
  const XMLElement* first = parent.FirstChildElement();
  if (first == nullptr) {
    Refuse(reading.file, parent.Name(), "has no rectangle, circle or polygon", parent.GetLineNum());
  }
  const Shape only = ReadShape(*first, reading);
  if (first->NextSiblingElement() == nullptr) {
    return only;
  }
  std::vector<Vec2> corners;
  for (const XMLElement* each = first; each != nullptr; each = each->NextSiblingElement()) {
    for (const Vec2& corner : ReadShape(*each, reading).box.Corners()) {
      corners.push_back(corner);
    }
  }
  return {EnclosingBox(corners), true};
}

/// A state of an obstacle.
struct State {
  double time = 0.0;  // [s]
  Pose2 place;
  bool has_yaw = false;
};

State ReadState(const XMLElement& element, const CommonRoadClock& clock,
                const CommonRoadReading& reading) {
  State state;
  const auto step = IntervalOfChild(element, "time", reading);
  state.time = clock.timestep * ((step ? step->middle() : clock.start) - clock.start);
  state.place = ReadPlace(element, reading);
  if (const auto yaw = IntervalOfChild(element, "orientation", reading)) {
    state.place.yaw = yaw->middle();
    state.has_yaw = true;
  }
  return state;
}

/// Numbers of approximated shapes, states and sets in a scenario.
struct Approximations {
  int boxes = 0;
  int sets = 0;
  int pieces = 0;  // boxes that cover the occupancy sets
  int skipped_states = 0;
  int without_place = 0;
};

/// Sets the headings of states without orientation to the direction of motion.
void CompleteYaws(std::vector<State>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].has_yaw || states.size() < 2) {
      continue;
    }
    const std::size_t from = i + 1 < states.size() ? i : i - 1;
    const Vec2 way = states[from + 1].place.position() - states[from].place.position();
    states[i].place.yaw =
        way.norm() > 1e-3 || i == 0 ? std::atan2(way.y(), way.x()) : states[i - 1].place.yaw;
  }
}

/// Reads the states of an obstacle: the initial state and the trajectory.
std::vector<State> ReadStates(const XMLElement& obstacle, const CommonRoadClock& clock,
                              const CommonRoadReading& reading, Approximations& notes) {
  std::vector<State> states;
  const auto add = [&](const State& state) {
    if (state.time < 0.0 || (!states.empty() && state.time <= states.back().time)) {
      ++notes.skipped_states;
    } else {
      states.push_back(state);
    }
  };
  const XMLElement* initial = obstacle.FirstChildElement("initialState");
  if (initial != nullptr) {
    add(ReadState(*initial, clock, reading));
  }
  if (const XMLElement* trajectory = obstacle.FirstChildElement("trajectory")) {
    for (const XMLElement* state = trajectory->FirstChildElement("state"); state != nullptr;
         state = state->NextSiblingElement("state")) {
      add(ReadState(*state, clock, reading));
    }
  } else if (initial != nullptr && states.size() == 1) {
    // An obstacle without a trajectory keeps its initial velocity.
    const auto speed = IntervalOfChild(*initial, "velocity", reading);
    if (speed && speed->middle() != 0.0) {
      State later = states.front();
      const Vec2 place = later.place.position() + speed->middle() * Direction(later.place.yaw);
      later.place = {place.x(), place.y(), later.place.yaw};
      later.time += 1.0;
      states.push_back(later);
    }
  }
  CompleteYaws(states);
  return states;
}

/// A box that an obstacle may occupy at a time [s].
using Occupancy = std::pair<double, OrientedBox>;

/// Returns the same box with the yaw of the side that is nearest to `yaw`. If the box's yaw changes
/// by a right angle, its length and width are swapped.
OrientedBox TurnedTo(double yaw, const OrientedBox& box) {
  const double turn = AngleDifference(yaw, box.center.yaw);
  const double quarters = std::round(turn / (0.5 * kPi));
  OrientedBox turned = box;
  turned.center.yaw = WrapAngle(box.center.yaw + 0.5 * kPi * quarters);
  if (std::abs(std::remainder(quarters, 2.0)) > 0.5) {
    std::swap(turned.length, turned.width);
  }
  return turned;
}

/// Reads the boxes around the places that an obstacle may occupy, in order of time. The first place
/// is the initial state's, if any; the places of the occupancy set follow.
std::vector<Occupancy> ReadOccupancies(const XMLElement& obstacle, const XMLElement& set,
                                       const CommonRoadClock& clock,
                                       const CommonRoadReading& reading) {
  std::vector<Occupancy> found;
  const auto add = [&](double time, const OrientedBox& box) {
    if (time >= 0.0 && (found.empty() || time > found.back().first)) {
      found.emplace_back(time, found.empty() ? box : TurnedTo(found.back().second.center.yaw, box));
    }
  };
  const XMLElement* shape = obstacle.FirstChildElement("shape");
  if (const XMLElement* initial = obstacle.FirstChildElement("initialState");
      initial != nullptr && shape != nullptr) {
    const State state = ReadState(*initial, clock, reading);
    OrientedBox box = ReadShapes(*shape, {reading.file, reading.largest}).box;
    box.center = Compose(state.place, box.center);
    add(state.time, box);
  }
  for (const XMLElement* each = set.FirstChildElement("occupancy"); each != nullptr;
       each = each->NextSiblingElement("occupancy")) {
    const OrientedBox box = ReadShapes(RequiredChild(*each, "shape", reading), reading).box;
    const auto step = IntervalOfChild(*each, "time", reading);
    add(clock.timestep * ((step ? step->middle() : 0.0) - clock.start), box);
  }
  return found;
}

/// Returns the offset of the box `index` from the middle of a row of `count` boxes that cover
/// `length`.
double PieceOffset(int index, int count, double length, double piece) {
  return count < 2 || length <= piece ? 0.0 : (length - piece) * (index / (count - 1.0) - 0.5);
}

/// Covers a sequence of occupied places of changing size by moving boxes of constant size. Each box
/// is as large as the smallest place. At each time of the occupancy set, the boxes together cover
/// exactly the occupied place. If an exact cover needs more than kMost boxes along one side, kMost
/// larger boxes cover more than the occupied place.
std::vector<CommonRoadObstacle> CoverOccupancies(const std::vector<Occupancy>& occupancies) {
  struct Side {
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0.0;
    int count = 1;
    double piece = 0.0;

    void Take(double size) {
      smallest = std::min(smallest, size);
      largest = std::max(largest, size);
    }
    void Divide() {
      constexpr int kMost = 8;
      // Tolerate an uncovered length of 1e-3 m, because the sizes of the places are rounded to four
      // decimals.
      count = std::min(kMost, static_cast<int>(std::ceil((largest - 1e-3) / smallest)));
      piece = count < kMost ? std::min(smallest + 1e-3, largest) : largest / count;
    }
  };
  Side along;
  Side across;
  for (const auto& [time, box] : occupancies) {
    along.Take(box.length);
    across.Take(box.width);
  }
  along.Divide();
  across.Divide();
  std::vector<CommonRoadObstacle> pieces;
  for (int i = 0; i < along.count; ++i) {
    for (int j = 0; j < across.count; ++j) {
      CommonRoadObstacle& piece = pieces.emplace_back();
      for (const auto& [time, box] : occupancies) {
        const Pose2 offset{PieceOffset(i, along.count, box.length, along.piece),
                           PieceOffset(j, across.count, box.width, across.piece), 0.0};
        piece.poses.emplace_back(time, Compose(box.center, offset));
      }
      piece.box = {piece.poses.front().second, along.piece, across.piece};
      if (piece.poses.size() == 1) {
        piece.poses.clear();
      }
    }
  }
  return pieces;
}

/// Reads an obstacle. An obstacle with an occupancy set is returned as several boxes.
std::vector<CommonRoadObstacle> ReadObstacle(const XMLElement& element, bool moves,
                                             const CommonRoadClock& clock,
                                             const CommonRoadReading& reading,
                                             Approximations& notes) {
  if (const XMLElement* set = element.FirstChildElement("occupancySet"); set != nullptr && moves) {
    const std::vector<Occupancy> occupancies = ReadOccupancies(element, *set, clock, reading);
    if (occupancies.empty()) {
      return {};
    }
    ++notes.sets;
    std::vector<CommonRoadObstacle> pieces = CoverOccupancies(occupancies);
    notes.pieces += static_cast<int>(pieces.size());
    return pieces;
  }
  const XMLElement* shapes = element.FirstChildElement("shape");
  const std::vector<State> states = ReadStates(element, clock, reading, notes);
  if (shapes == nullptr || states.empty()) {
    ++notes.without_place;
    return {};
  }
  // The coordinates of a shape are in the frame of the obstacle.
  const Shape shape = ReadShapes(*shapes, {reading.file, reading.largest});
  notes.boxes += shape.is_larger ? 1 : 0;
  CommonRoadObstacle obstacle{.box = shape.box};
  obstacle.box.center = Compose(states.front().place, shape.box.center);
  const bool is_static = !moves || std::all_of(states.begin(), states.end(), [&](const State& s) {
    return s.place == states.front().place;
  });
  if (!is_static && states.size() > 1) {
    for (const State& state : states) {
      obstacle.poses.emplace_back(state.time, Compose(state.place, shape.box.center));
    }
  }
  return {obstacle};
}

}  // namespace

Pose2 ReadPlace(const XMLElement& state, const CommonRoadReading& reading) {
  const XMLElement& position = RequiredChild(state, "position", reading);
  if (const XMLElement* point = position.FirstChildElement("point")) {
    const Vec2 place = PointIn(*point, reading);
    return {place.x(), place.y(), 0.0};
  }
  const Pose2 center = ReadShapes(position, reading).box.center;
  return {center.x, center.y, 0.0};
}

CommonRoadRegion ReadRegion(const XMLElement& shape, const CommonRoadReading& reading) {
  const Shape read = ReadShape(shape, reading);
  if (std::string_view(shape.Name()) == "circle") {
    return {.center = read.box.center.position(), .radius = 0.5 * read.box.length};
  }
  const auto corners = read.box.Corners();
  return {.corners = {corners.begin(), corners.end()}};
}

std::vector<CommonRoadObstacle> ReadCommonRoadObstacles(const XMLElement& root,
                                                        const CommonRoadClock& clock,
                                                        const CommonRoadReading& reading,
                                                        std::vector<std::string>& notes) {
  std::vector<CommonRoadObstacle> obstacles;
  Approximations counted;
  for (const XMLElement* child = root.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    const XMLElement* role = child->FirstChildElement("role");
    const char* text = role == nullptr ? nullptr : role->GetText();
    const bool is_dynamic =
        name == "dynamicObstacle" || name == "phantomObstacle" ||
        (name == "obstacle" && text != nullptr && std::string_view(text) == "dynamic");
    if (is_dynamic || name == "staticObstacle" || name == "obstacle") {
      for (CommonRoadObstacle& found : ReadObstacle(*child, is_dynamic, clock, reading, counted)) {
        obstacles.push_back(std::move(found));
      }
    }
  }
  const auto note = [&](int count, const char* what) {
    if (count > 0) {
      notes.push_back(fmt::format("{} {}", count, what));
    }
  };
  note(counted.boxes, "obstacles are discs or polygons; their enclosing boxes are larger");
  if (counted.sets > 0) {
    notes.push_back(fmt::format("{} obstacles are sets of occupied places: {} boxes cover them",
                                counted.sets, counted.pieces));
  }
  note(counted.skipped_states, "states of obstacles are not later than the state before: left out");
  note(counted.without_place, "obstacles have no shape or no state: left out");
  return obstacles;
}

}  // namespace trackbed
