#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"

// Recognizes headings that are not radians from the x axis. For each common meaning of a heading,
// the reader converts the headings to radians from the x axis, and compares them with the direction
// of travel at the points, or with the opposite direction where the car may drive in reverse. The
// meaning with the smallest mean difference is the most probable one.
namespace trackbed {
namespace {

/// A meaning of the numbers in a column of headings: `sign * unit * number + offset` is the heading
/// in radians from the x axis, positive to the left.
struct HeadingMeaning {
  double unit;
  double sign;
  double offset;
  const char* remedy;  ///< Change that the user should make; empty for radians from the x axis.
};

constexpr double kDegree = kPi / 180.0;
constexpr const char* kConvert =
    "convert them to angles from the x axis, positive to the left, or remove the column";

const std::array<HeadingMeaning, 5> kMeanings{{
    {1.0, 1.0, 0.0, ""},
    {kDegree, 1.0, 0.0, "degrees; set columns.yaw_unit: deg"},
    {1.0, -1.0, 0.5 * kPi, "radians, clockwise from north"},
    {kDegree, -1.0, 0.5 * kPi, "degrees, clockwise from north"},
    {1.0, 1.0, 0.5 * kPi, "radians from north, positive to the left"},
}};

/// A given heading, and the direction of travel at its point [rad].
struct Heading {
  double number;
  double travel;
  double weight;  ///< Length of the step from which the direction of travel follows [m].
};

/// Returns the headings at both ends of each step between two different points.
std::vector<Heading> HeadingsOf(const PathPoints& points) {
  std::vector<Heading> headings;
  for (std::size_t i = 0; i + 1 < points.yaw.size(); ++i) {
    const Vec2 along = points.points[i + 1] - points.points[i];
    if (along.norm() > 0.0) {
      const double travel = std::atan2(along.y(), along.x());
      headings.push_back({points.yaw[i], travel, along.norm()});
      headings.push_back({points.yaw[i + 1], travel, along.norm()});
    }
  }
  return headings;
}

double Difference(const Heading& heading, const HeadingMeaning& meaning) {
  const double yaw = meaning.sign * meaning.unit * heading.number + meaning.offset;
  return std::abs(AngleDifference(yaw, heading.travel));
}

/// Returns the mean difference of the headings from the direction of travel, or from the opposite
/// direction for steps in reverse [rad]. Longer steps have larger weights.
double MeanDifference(const std::vector<Heading>& headings, const HeadingMeaning& meaning) {
  double sum = 0.0;
  double length = 0.0;
  for (const Heading& heading : headings) {
    const double difference = Difference(heading, meaning);
    sum += heading.weight * std::min(difference, kPi - difference);
    length += heading.weight;
  }
  return sum / length;
}

}  // namespace

std::string HeadingUnitProblem(const PathPoints& points) {
  // Heading difference [rad] above which a heading is against the direction of travel.
  constexpr double kOpposite = 2.0;
  const std::vector<Heading> headings = HeadingsOf(points);
  const bool fits = std::none_of(headings.begin(), headings.end(), [](const Heading& heading) {
    return Difference(heading, kMeanings.front()) > kOpposite;
  });
  if (fits) {
    return "";
  }
  // Headings that have nothing to do with the path differ by an eighth of a turn on average.
  constexpr double kFits = 0.3;  // [rad]
  const HeadingMeaning* best = &kMeanings.front();
  double least = MeanDifference(headings, *best);
  if (least <= kFits) {
    return "";  // the car drives in reverse
  }
  for (const HeadingMeaning& meaning : kMeanings) {
    if (const double own = MeanDifference(headings, meaning); own < least) {
      best = &meaning;
      least = own;
    }
  }
  if (least > kFits) {
    return "";
  }
  const std::string remedy = best->remedy;
  return fmt::format(
      "the headings are against the direction of travel if they are radians from the x axis, but "
      "fit the path within {:.3g} rad on average if they are {}{}{}",
      least, remedy, best->offset != 0.0 ? "; " : "", best->offset != 0.0 ? kConvert : "");
}

}  // namespace trackbed
