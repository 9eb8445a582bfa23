#include "trackbed/planning/curves/dubins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/curves/curve_goal.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

constexpr double kTurn = 2.0 * kPi;
constexpr double kNone = std::numeric_limits<double>::infinity();

constexpr double kRounding = 1e-12;

/// Wraps an angle to [0, 2 pi); an angle that equals 2 pi up to rounding becomes 0.
double Positive(double angle) {
  const double turned = angle - kTurn * std::floor(angle / kTurn);
  return turned > kTurn - kRounding ? 0.0 : turned;
}

/// Arc angles of a Dubins word [rad]. If the middle piece is a straight, `middle` is its length in
/// radii.
struct Sweeps {
  double first = 0.0;
  double middle = 0.0;
  double last = 0.0;

  [[nodiscard]] double Sum() const { return first + middle + last; }
};

/// Each of the following functions computes one Dubins word that begins with a left arc and is
/// shorter than `limit`. If no word shorter than `limit` exists, the functions return kNone as the
/// middle piece. In units of the turning radius, the center of the first arc is at (0, 1). The last
/// arc ends at the goal (x, y). Its center is at (x - sin, y + cos) for a left arc, and at (x +
/// sin, y - cos) for a right arc, with the sine and cosine of the goal heading.
Sweeps LeftStraightLeft(const CurveGoal& goal, double limit) {
  const double dx = goal.x - goal.sin;
  const double dy = goal.y - 1.0 + goal.cos;
  const double straight = std::sqrt(dx * dx + dy * dy);
  if (straight >= limit) {
    return {.middle = kNone};
  }
  const double first = Positive(std::atan2(dy, dx));
  return {first, straight, Positive(goal.yaw - first)};
}

Sweeps LeftStraightRight(const CurveGoal& goal, double limit) {
  const double dx = goal.x + goal.sin;
  const double dy = goal.y - 1.0 - goal.cos;
  const double square = dx * dx + dy * dy - 4.0;
  if (square < -kRounding) {
    return {.middle = kNone};  // the two circles overlap, so they have no inner tangent
  }
  const double straight = std::sqrt(std::max(square, 0.0));
  if (straight >= limit) {
    return {.middle = kNone};
  }
  // Compute the sum of the direction between the centers and atan(2/straight) with a single
  // arctangent.
  const double first = Positive(std::atan2(dy * straight + 2.0 * dx, dx * straight - 2.0 * dy));
  return {first, straight, Positive(first - goal.yaw)};
}

Sweeps LeftRightLeft(const CurveGoal& goal, double limit) {
  const double dx = goal.x - goal.sin;
  const double dy = goal.y - 1.0 + goal.cos;
  const double square = dx * dx + dy * dy;
  if (square > 16.0 + kRounding || limit <= kPi) {
    // The first and the last circle are too far apart for a middle circle that touches both.
    return {.middle = kNone};
  }
  // The line from the first center to the middle center is rotated to the left by `tilt`, relative
  // to the line from the first to the last center.
  const double tilt = std::acos(std::min(0.25 * std::sqrt(square), 1.0));
  const double middle = kPi + 2.0 * tilt;
  const double first = Positive(std::atan2(dy, dx) + 0.5 * kPi + tilt);
  return {first, middle, Positive(goal.yaw - first + middle)};
}

using Word = Sweeps (*)(const CurveGoal&, double limit);

struct Family {
  Word word;
  Bend middle;
  Bend last;
};

constexpr std::array<Family, 3> kFamilies{{
    {LeftStraightLeft, Bend::kNone, Bend::kLeft},
    {LeftStraightRight, Bend::kNone, Bend::kRight},
    {LeftRightLeft, Bend::kRight, Bend::kLeft},
}};

Bend MirroredBend(Bend bend, bool mirrored) {
  return mirrored ? static_cast<Bend>(-static_cast<int>(bend)) : bend;
}

ShortestCurve MakeCurve(const Family& family, bool mirrored, const Sweeps& sweeps, double radius) {
  return {.radius = radius,
          .pieces = {{{MirroredBend(Bend::kLeft, mirrored), sweeps.first},
                      {MirroredBend(family.middle, mirrored), sweeps.middle},
                      {MirroredBend(family.last, mirrored), sweeps.last}}},
          .count = 3,
          .length = radius * sweeps.Sum()};
}

}  // namespace

ShortestCurve Dubins(const Pose2& from, const Pose2& to, double radius) {
  const CurveGoal goal(from, to, radius);
  const std::array<CurveGoal, 2> goals{goal, goal.Mirrored()};
  Sweeps best{.middle = kNone};
  const Family* best_family = kFamilies.data();
  bool best_mirrored = false;
  for (const Family& family : kFamilies) {
    for (const bool mirrored : {false, true}) {
      const Sweeps sweeps = family.word(goals[mirrored ? 1 : 0], best.Sum());
      if (sweeps.Sum() < best.Sum()) {
        best = sweeps;
        best_family = &family;
        best_mirrored = mirrored;
      }
    }
  }
  return MakeCurve(*best_family, best_mirrored, best, radius);
}

std::vector<ShortestCurve> DubinsWords(const Pose2& from, const Pose2& to, double radius) {
  const CurveGoal goal(from, to, radius);
  std::vector<ShortestCurve> words;
  for (const Family& family : kFamilies) {
    for (const bool mirrored : {false, true}) {
      const Sweeps sweeps = family.word(mirrored ? goal.Mirrored() : goal, kNone);
      if (sweeps.Sum() < kNone) {
        words.push_back(MakeCurve(family, mirrored, sweeps, radius));
      }
    }
  }
  std::stable_sort(words.begin(), words.end(), [](const ShortestCurve& a, const ShortestCurve& b) {
    return a.length < b.length;
  });
  return words;
}

}  // namespace trackbed
