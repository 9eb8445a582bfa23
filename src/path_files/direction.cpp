#include "src/path_files/direction.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "src/path_files/reading.h"
#include "trackbed/core/text_table.h"
#include "trackbed/geometry/pose.h"

// Reads directions of motion: from cells of a column of directions or gears, and from the signs of
// speeds.
namespace trackbed {
namespace {

/// Words for directions of motion, in lower case; 0: the car stands.
const std::map<std::string, int>& DirectionWords() {
  static const std::map<std::string, int> words{
      {"forward", 1}, {"forwards", 1}, {"fwd", 1},    {"f", 1},          {"drive", 1},
      {"d", 1},       {"ahead", 1},    {"true", 1},   {"backward", -1},  {"backwards", -1},
      {"back", -1},   {"bwd", -1},     {"b", -1},     {"reverse", -1},   {"reversing", -1},
      {"rev", -1},    {"r", -1},       {"false", -1}, {"neutral", 0},    {"n", 0},
      {"park", 0},    {"parking", 0},  {"p", 0},      {"standstill", 0}, {"stop", 0},
      {"stopped", 0}};
  return words;
}

}  // namespace

std::optional<int> DirectionIn(const std::string& cell, DirectionColumn column) {
  std::string word = boost::to_lower_copy(boost::trim_copy(cell));
  for (const char* prefix : {"gear_", "direction_"}) {
    if (word.starts_with(prefix)) {
      word.erase(0, std::string(prefix).size());
    }
  }
  const int sign = column == DirectionColumn::kReverse ? -1 : 1;
  if (const auto found = DirectionWords().find(word); found != DirectionWords().end()) {
    const bool is_logical = word == "true" || word == "false";
    return is_logical ? sign * found->second : found->second;
  }
  const std::optional<double> number = CellNumber(word);
  constexpr double kMaxGear = 20.0;
  const double largest = column == DirectionColumn::kGear ? kMaxGear : 1.0;
  if (!number || *number != std::round(*number) || *number < -largest || *number > largest) {
    return std::nullopt;
  }
  if (*number == 0.0) {
    const bool is_logical =
        column == DirectionColumn::kForward || column == DirectionColumn::kReverse;
    return is_logical ? -sign : 0;
  }
  return *number > 0.0 ? sign : -sign;
}

void TakeSignedSpeeds(PathPoints& points) {
  // Speed below which the car counts as standing, because the sign of a lower speed is uncertain:
  // the fraction kStandingShare of the largest speed, at most kStanding [m/s].
  constexpr double kStandingShare = 0.1;
  constexpr double kStanding = 0.05;
  double largest = 0.0;
  for (const double speed : points.speed) {
    largest = std::max(largest, std::abs(speed));
  }
  const double standing = std::min(kStanding, kStandingShare * largest);
  const auto sign = [&](double speed) {
    return std::abs(speed) <= standing ? 0 : speed > 0.0 ? 1 : -1;
  };
  const bool has_reverse = std::any_of(points.speed.begin(), points.speed.end(),
                                       [&](double speed) { return sign(speed) < 0; });
  if (has_reverse && points.direction.empty()) {
    points.direction.assign(points.speed.size(), 0);
  }
  for (std::size_t i = 0; i < points.speed.size(); ++i) {
    if (has_reverse && points.direction[i] == 0) {
      points.direction[i] = sign(points.speed[i]);
    }
    points.speed[i] = std::abs(points.speed[i]);
  }
}

std::string HalfTurnProblem(const PathPoints& points) {
  // Headings count as opposite up to this mean cosine of the angle between headings and steps.
  constexpr double kOpposite = -0.8;
  double length = 0.0;
  double progress = 0.0;
  for (std::size_t i = 0; i + 1 < points.yaw.size(); ++i) {
    const Vec2 step = points.points[i + 1] - points.points[i];
    length += step.norm();
    progress += 0.5 * step.dot(Direction(points.yaw[i]) + Direction(points.yaw[i + 1]));
  }
  if (!points.direction.empty() || length == 0.0 || progress > kOpposite * length) {
    return "";
  }
  return "the headings are opposite to the direction of travel all along the path, but no speed is "
         "negative: correct the headings by half a turn or remove their column; if the car drives "
         "in reverse, make the speeds negative or add a column direction of -1";
}

}  // namespace trackbed
