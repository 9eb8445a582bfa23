#include "src/path/legs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/path/points_to_fit.h"
#include "trackbed/geometry/pose.h"

// Divides points into legs of one direction of motion. Each step between two different points has a
// progress: the distance by which the car moves forwards, negative in reverse. The sign of a step's
// progress is the given direction of motion at both points. If the directions are missing or
// differ, the headings determine the sign. Dynamic programming (Viterbi) finds the directions that
// maximize the sum of
//     direction * progress
// over all steps, minus a penalty for each change of direction, plus a bonus for changes of
// direction at points where the steps turn back. The penalty for a change of direction makes the
// legs robust to noise: while a car stands, noise moves its positions back by less than the
// penalty.

namespace trackbed {
namespace {

/// Successive given points at the same position.
struct Place {
  std::size_t first = 0;  // Index of the first point at the position.
  std::size_t last = 0;   // Index of the last point at the position.
};

std::vector<Place> PlacesOf(const PathPoints& given) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    if (places.empty() ||
        (given.points[i] - given.points[places.back().first]).norm() > kEqualityTolerance) {
      places.push_back({i, i});
    } else {
      places.back().last = i;
    }
  }
  return places;
}

/// Returns the distance by which the car moves forwards from point `from` to point `to` [m].
double ProgressOf(const PathPoints& given, std::size_t from, std::size_t to) {
  const Vec2 step = given.points[to] - given.points[from];
  if (!given.direction.empty()) {
    const int sum = given.direction[from] + given.direction[to];
    if (sum != 0) {
      return 0.5 * sum * step.norm();
    }
  }
  return given.yaw.empty() ? 0.0
                           : 0.5 * step.dot(Direction(given.yaw[from]) + Direction(given.yaw[to]));
}

/// Returns the direction of motion of each step between two places.
std::vector<int> DirectionsOf(const PathPoints& given, const std::vector<Place>& places,
                              const std::vector<double>& progress, double noise) {
  // Bonus for a change of direction where the steps turn back by 180 degrees, divided by the length
  // of the shorter of the two steps. The bonus for steps that turn back is below 1, because given
  // directions and headings are better evidence than the positions.
  constexpr double kTurnShare = 0.5;
  constexpr std::array<int, 2> kDirections{1, -1};
  const auto at = [&](std::size_t place) { return given.points[places[place].first]; };
  std::array<double, 2> best{progress[0], -progress[0]};
  std::vector<std::array<std::size_t, 2>> before(progress.size());
  for (std::size_t i = 1; i < progress.size(); ++i) {
    const Vec2 in = at(i) - at(i - 1);
    const Vec2 out = at(i + 1) - at(i);
    const double turned_back =
        -kTurnShare * in.dot(out) / std::max(in.norm(), out.norm());  // [m], > 0 if steps turn back
    std::array<double, 2> next{};
    for (std::size_t own = 0; own < 2; ++own) {
      const double stays = best[own] - turned_back;
      const double changes = best[1 - own] + turned_back - noise;
      before[i][own] = changes > stays ? 1 - own : own;
      next[own] = std::max(stays, changes) + kDirections[own] * progress[i];
    }
    best = next;
  }
  std::vector<int> directions(progress.size());
  std::size_t own = best[1] > best[0] ? 1 : 0;
  for (std::size_t i = progress.size(); i-- > 0;) {
    directions[i] = kDirections[own];
    own = before[i][own];
  }
  return directions;
}

}  // namespace

std::vector<Leg> FindLegs(const PathPoints& given, double noise) {
  const std::vector<Leg> forward{{0, given.points.size() - 1, 1}};
  if (given.direction.empty() && given.yaw.empty()) {
    return forward;
  }
  const std::vector<Place> places = PlacesOf(given);
  std::vector<double> progress;
  for (std::size_t i = 1; i < places.size(); ++i) {
    progress.push_back(ProgressOf(given, places[i - 1].last, places[i].first));
  }
  if (std::all_of(progress.begin(), progress.end(), [](double own) { return own >= 0.0; })) {
    return forward;
  }
  const std::vector<int> directions = DirectionsOf(given, places, progress, noise);
  std::vector<Leg> legs{{0, 0, directions.front()}};
  for (std::size_t i = 1; i < directions.size(); ++i) {
    if (directions[i] != directions[i - 1]) {
      legs.back().last = places[i].first;
      legs.push_back({places[i].first, 0, directions[i]});
    }
  }
  legs.back().last = given.points.size() - 1;
  return legs;
}

PathPoints PointsOf(const PathPoints& given, const Leg& leg) {
  const auto begin = static_cast<std::ptrdiff_t>(leg.first);
  const auto end = static_cast<std::ptrdiff_t>(leg.last) + 1;
  PathPoints own;
  own.points.assign(given.points.begin() + begin, given.points.begin() + end);
  if (!given.lines.empty()) {
    own.lines.assign(given.lines.begin() + begin, given.lines.begin() + end);
  }
  return own;
}

std::vector<Segment> InDirection(std::vector<Segment> forward, int direction) {
  for (Segment& segment : forward) {
    segment.direction = direction;
    segment.curvature *= direction;
    segment.sharpness *= direction;
    segment.sharpness_rate *= direction;
  }
  return forward;
}

}  // namespace trackbed
