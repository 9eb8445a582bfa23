#include "src/path_files/heading_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "src/path_files/reading.h"
#include "trackbed/core/angle.h"

// Decides how the headings of a path are measured. For each common meaning of a heading, the reader
// converts the headings to radians from the x axis, and compares them with the direction of travel
// at the points. A car that is driven in reverse has the opposite heading, so directions are
// compared without their sign. The meanings "from the x axis" and "from north, positive to the
// left" differ by 90 degrees and cannot be confused; the reader accepts both meanings. The reader
// refuses all other meanings, and names the remedy.
namespace trackbed {
namespace {

/// A meaning of the numbers in a column of headings: `sign * unit * number + offset` is the heading
/// in radians from the x axis, positive to the left.
struct HeadingMeaning {
  double unit;
  double sign;
  double offset;
  const char* remedy;  ///< Change that the user should make; empty for accepted meanings.
};

constexpr double kDegree = kPi / 180.0;
constexpr const char* kConvert =
    "; convert them to angles from the x axis, positive to the left, or remove the column";

constexpr HeadingMeaning kFromX{1.0, 1.0, 0.0, ""};
constexpr HeadingMeaning kFromNorth{1.0, 1.0, 0.5 * kPi, ""};
constexpr std::array<HeadingMeaning, 3> kOthers{{
    {kDegree, 1.0, 0.0, "degrees; set columns.yaw_unit: deg"},
    {1.0, -1.0, 0.5 * kPi, "radians, clockwise from north"},
    {kDegree, -1.0, 0.5 * kPi, "degrees, clockwise from north"},
}};

/// Mean difference between headings and direction of travel up to which a meaning fits [rad]: half
/// of the 45 degrees by which unrelated directions differ on average.
constexpr double kFits = kPi / 8.0;

/// A given heading, and the direction of travel of a step that begins or ends at its point [rad].
struct Heading {
  double number;
  double travel;
  double weight;  ///< Length of the step [m].
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

/// Returns the mean difference between the headings and the direction of travel or its opposite
/// [rad], from 0 to 90 degrees. The mean is weighted by distance, because the direction of travel
/// is inaccurate where points are close together.
double MeanDifference(const std::vector<Heading>& headings, const HeadingMeaning& meaning) {
  double sum = 0.0;
  double weight = 0.0;
  for (const Heading& heading : headings) {
    const double yaw = meaning.sign * meaning.unit * heading.number + meaning.offset;
    const double difference = std::abs(AngleDifference(yaw, heading.travel));
    sum += heading.weight * std::min(difference, kPi - difference);
    weight += heading.weight;
  }
  return sum / weight;
}

/// Compares the mean errors of two interpretations of the headings. Returns whether `other`, the
/// error of a rejected interpretation, is much smaller than `least`, the error of the accepted one.
/// If a rejected interpretation fits much better, the headings fit the accepted one only by
/// accident, because the path hardly turns.
bool IsMuchBetter(double other, double least) {
  constexpr double kExact = 0.05;  // Mean difference up to which an accepted meaning is certain.
  return least > kExact && other < 0.25 * least;
}

}  // namespace

HeadingReading ReadHeadings(const PathPoints& points, bool is_racing_line, HeadingUnit unit) {
  const std::vector<Heading> headings = HeadingsOf(points);
  if (headings.empty()) {
    return {};
  }
  const double from_x = MeanDifference(headings, kFromX);
  const double from_north = MeanDifference(headings, kFromNorth);
  const double least = std::min(from_x, from_north);
  // Numbers beyond a whole turn are probably degrees.
  const bool exceeds_turn = std::any_of(headings.begin(), headings.end(), [](const Heading& own) {
    return std::abs(own.number) > 2.0 * kPi;
  });
  const bool may_be_degrees = unit == HeadingUnit::kUnknown
                                  ? exceeds_turn || least > kFits
                                  : unit == HeadingUnit::kNamedRadians && exceeds_turn;
  const HeadingMeaning* best = nullptr;
  double best_difference = kFits;
  for (const HeadingMeaning& meaning : kOthers) {
    const double difference = MeanDifference(headings, meaning);
    if ((meaning.unit == 1.0 || may_be_degrees) && difference < best_difference) {
      best = &meaning;
      best_difference = difference;
    }
  }
  HeadingReading reading;
  if (best != nullptr && (least > kFits || IsMuchBetter(best_difference, least))) {
    reading.problem = fmt::format(
        "the headings are {:.3g} rad from the direction of travel on average if they are radians "
        "from the x axis, but {:.3g} rad if they are {}{}",
        from_x, best_difference, best->remedy, best->offset != 0.0 ? kConvert : "");
  } else if (least > kFits) {
    reading.problem =
        is_racing_line
            ? fmt::format(
                  "the headings do not fit the path: on average they are {:.3g} rad from "
                  "the direction of travel if they are measured from the x axis, and "
                  "{:.3g} rad if they are measured from north; must be at most {:.3g} rad: "
                  "correct the headings, or remove the column",
                  from_x, from_north, kFits)
            : "";
  } else {
    reading.offset = from_north < from_x ? kFromNorth.offset : kFromX.offset;
    if (is_racing_line || reading.offset != 0.0) {
      reading.note = fmt::format(
          "is taken from {}: within {:.2g} rad of the direction of travel on average",
          reading.offset != 0.0 ? "north, positive to the left, as in TUM's racing lines"
                                : "the x axis",
          least);
    }
  }
  return reading;
}

}  // namespace trackbed
