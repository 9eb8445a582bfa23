#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/path_files/formats.h"
#include "trackbed/core/angle.h"

// Recognizes headings that are not radians from the x axis. For each common meaning of a heading,
// the reader converts the headings to radians from the x axis, and compares them with the direction
// of travel at the points. The meaning with the smallest mean difference is the most probable one.
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
};

std::vector<Heading> HeadingsOf(const PathPoints& points) {
  std::vector<Heading> headings;
  for (std::size_t i = 0; i < points.yaw.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, points.points.size() - 1);
    const Vec2 along = points.points[after] - points.points[before];
    if (along.norm() > 0.0) {
      headings.push_back({points.yaw[i], std::atan2(along.y(), along.x())});
    }
  }
  return headings;
}

double Difference(const Heading& heading, const HeadingMeaning& meaning) {
  const double yaw = meaning.sign * meaning.unit * heading.number + meaning.offset;
  return std::abs(AngleDifference(yaw, heading.travel));
}

}  // namespace

std::string HeadingUnitProblem(const PathPoints& points) {
  // Heading difference [rad] above which FitPath rejects a heading.
  constexpr double kOpposite = 2.0;
  const std::vector<Heading> headings = HeadingsOf(points);
  const bool fits = std::none_of(headings.begin(), headings.end(), [](const Heading& heading) {
    return Difference(heading, kMeanings.front()) > kOpposite;
  });
  if (fits) {
    return "";
  }
  const HeadingMeaning* best = nullptr;
  double least = 0.0;
  for (const HeadingMeaning& meaning : kMeanings) {
    double sum = 0.0;
    for (const Heading& heading : headings) {
      const double difference = Difference(heading, meaning);
      // A car that is driven in reverse has the opposite heading, in radians from the x axis.
      sum += &meaning == &kMeanings.front() ? std::min(difference, kPi - difference) : difference;
    }
    if (best == nullptr || sum < least) {
      best = &meaning;
      least = sum;
    }
  }
  const bool best_fits =
      std::none_of(headings.begin(), headings.end(),
                   [&](const Heading& heading) { return Difference(heading, *best) > kOpposite; });
  if (best == &kMeanings.front() || !best_fits) {
    return "";
  }
  const std::string remedy = best->remedy;
  return fmt::format(
      "the headings are against the direction of travel if they are radians from the x axis, but "
      "fit the path within {:.3g} rad on average if they are {}{}{}",
      least / static_cast<double>(headings.size()), remedy, best->offset != 0.0 ? "; " : "",
      best->offset != 0.0 ? kConvert : "");
}

}  // namespace trackbed
