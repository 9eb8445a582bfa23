#include "trackbed/planning/curves/reeds_shepp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/curves/curve_goal.h"
#include "trackbed/core/angle.h"

// Shortest paths of a car that drives forwards and backwards (Reeds and Shepp 1990, section 8). A
// word is a sequence of arcs and straights. Eight functions compute the base words, whose first arc
// turns left and is driven forwards. Three symmetries turn a base word into the other words of its
// family: exchanging forward and reverse, exchanging left and right, and driving the pieces in the
// opposite order. The result of ShortestWord is the shortest of all words to the goal. To save
// time, a function may stop as soon as its word is longer than the shortest word found so far.

namespace trackbed {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kRight = 0.5 * kPi;  // Right angle [rad].
/// Largest magnitude of an arc angle that counts as zero [rad].
constexpr double kRounding = 1e-12;

/// Wraps an angle to [-pi, pi].
double WrapToPi(double angle) {
  return angle - 2.0 * kPi * std::nearbyint(angle * (0.5 / kPi));
}

/// Wraps an angle as WrapToPi does, but returns pi instead of -pi, for arc angles that must not be
/// negative.
double WrapNonNegative(double angle) {
  const double near = WrapToPi(angle);
  return near < kRounding - kPi ? near + 2.0 * kPi : near;
}

/// Wraps an angle as WrapToPi does, but returns -pi instead of pi, for arc angles that must not be
/// positive.
double WrapNonPositive(double angle) {
  return -WrapNonNegative(-angle);
}

/// Returns the square root of a value that may be slightly negative due to rounding.
double Root(double square) {
  return std::sqrt(std::max(square, 0.0));
}

/// The sweeps t, u and v (angles of arcs, lengths of straights) that define a Reeds-Shepp word of
/// three to five pieces. The member `sum` is the sum of the magnitudes of all sweeps, including
/// fixed right angles. If the Reeds-Shepp word does not exist, `sum` is kNone.
struct Sweeps {
  double t = 0.0;
  double u = 0.0;
  double v = 0.0;
  double sum = kNone;
};

Sweeps With(double t, double u, double v, double others = 0.0) {
  return {t, u, v, std::abs(t) + std::abs(u) + std::abs(v) + others};
}

// Each of the following functions solves an equation of Reeds and Shepp 1990, section 8, for a word
// whose first arc turns left and is driven forwards. The functions may ignore words longer than
// `limit`. In the names of words, L is an arc to the left, R an arc to the right and S a straight
// line. In a word such as L+S-R+, the sign + means forwards, and - means in reverse.

/// Returns the vector from the center of the first arc to the center of the last arc. ToLeftCenter
/// assumes that the last arc turns left, and ToRightCenter that it turns right.
Vec2 ToLeftCenter(const CurveGoal& goal) {
  return {goal.x - goal.sin, goal.y - 1.0 + goal.cos};
}
Vec2 ToRightCenter(const CurveGoal& goal) {
  return {goal.x + goal.sin, goal.y - 1.0 - goal.cos};
}

/// Equation 8.1 gives the Reeds-Shepp word L+S+L+.
Sweeps LSL(const CurveGoal& goal, double limit) {
  const Vec2 d = ToLeftCenter(goal);
  const double u = d.norm();
  if (u >= limit || d.y() < -kRounding) {
    return {};  // reject the word, because its first arc would turn to the right
  }
  const double t = WrapNonNegative(std::atan2(d.y(), d.x()));
  const double v = WrapNonNegative(goal.yaw - t);
  return v >= -kRounding ? With(t, u, v) : Sweeps{};
}

/// Equation 8.2 gives the Reeds-Shepp word L+S+R+.
Sweeps LSR(const CurveGoal& goal, double limit) {
  const Vec2 d = ToRightCenter(goal);
  const double square = d.squaredNorm() - 4.0;
  if (square < -kRounding || square >= limit * limit) {
    return {};
  }
  const double u = Root(square);
  const double t = WrapNonNegative(std::atan2(d.y() * u + 2.0 * d.x(), d.x() * u - 2.0 * d.y()));
  const double v = WrapNonNegative(t - goal.yaw);
  return t >= -kRounding && v >= -kRounding ? With(t, u, v) : Sweeps{};
}

/// Equations 8.3 and 8.4 give the Reeds-Shepp words L+R-L, whose last arc is driven forwards or in
/// reverse.
Sweeps LRL(const CurveGoal& goal, double /*limit*/) {
  const Vec2 d = ToLeftCenter(goal);
  const double square = d.squaredNorm();
  if (square > 16.0 + kRounding) {
    return {};
  }
  const double u = -2.0 * std::asin(std::min(0.25 * std::sqrt(square), 1.0));
  const double t = WrapNonNegative(std::atan2(d.y(), d.x()) + 0.5 * u + kPi);
  return t >= -kRounding ? With(t, u, WrapToPi(goal.yaw - t + u)) : Sweeps{};
}

/// Computes the outer arcs of a word of four arcs whose inner arcs sweep u and v.
template <typename Last>
Sweeps OuterOfFour(const Vec2& d, double u, double v, double yaw, const Last& last) {
  const double delta = WrapToPi(u - v);
  const double a = std::sin(u) - std::sin(delta);
  const double b = std::cos(u) - std::cos(delta) - 1.0;
  const double turned = std::atan2(d.y() * a - d.x() * b, d.x() * a + d.y() * b);
  const double sign = 2.0 * (std::cos(delta) - std::cos(v) - std::cos(u)) + 3.0;
  const double tau = WrapNonNegative(sign < 0.0 ? turned + kPi : turned);
  return With(tau, u, last(tau - u + v - yaw), std::abs(v));
}

/// Equation 8.7 gives the Reeds-Shepp word L+R+L-R-, whose inner arcs sweep u and -u.
Sweeps LRLR(const CurveGoal& goal, double /*limit*/) {
  const Vec2 d = ToRightCenter(goal);
  const double square = d.squaredNorm();
  if (square > 4.0 + kRounding) {
    return {};
  }
  const double u = std::acos(std::min(0.25 * (2.0 + std::sqrt(square)), 1.0));
  const Sweeps sweeps = OuterOfFour(d, u, -u, goal.yaw, WrapNonPositive);
  return sweeps.t >= -kRounding && sweeps.v <= kRounding ? sweeps : Sweeps{};
}

/// Equation 8.8 gives the Reeds-Shepp word L+R-L-R+, whose inner arcs both sweep u.
Sweeps LRLRInner(const CurveGoal& goal, double /*limit*/) {
  const Vec2 d = ToRightCenter(goal);
  const double rho = (20.0 - d.squaredNorm()) / 16.0;
  if (rho < 0.0 || rho > 1.0 + kRounding) {
    return {};
  }
  const double u = -std::acos(std::min(rho, 1.0));
  const Sweeps sweeps = OuterOfFour(d, u, u, goal.yaw, WrapNonNegative);
  return sweeps.t >= -kRounding && sweeps.v >= -kRounding ? sweeps : Sweeps{};
}

/// Equation 8.9 gives the Reeds-Shepp word L+R-S-L-, whose second arc is a right angle.
Sweeps LRSL(const CurveGoal& goal, double limit) {
  const Vec2 d = ToLeftCenter(goal);
  const double square = d.squaredNorm() - 4.0;
  const double r = Root(square);
  const double u = 2.0 - r;
  if (square < -kRounding || u > kRounding || kRight - u >= limit) {
    return {};
  }
  // Compute the sum of the angles of the vectors d and (-2, r) with a single arctangent.
  const double t = WrapNonNegative(std::atan2(d.x() * r - 2.0 * d.y(), -2.0 * d.x() - d.y() * r));
  const double v = WrapNonPositive(goal.yaw - kRight - t);
  const bool fits = t >= -kRounding && v <= kRounding;
  return fits ? With(t, u, v, kRight) : Sweeps{};
}

/// Equation 8.10 gives the Reeds-Shepp word L+R-S-R-, whose second arc is a right angle.
Sweeps LRSR(const CurveGoal& goal, double limit) {
  const Vec2 d = ToRightCenter(goal);
  const double u = 2.0 - d.norm();
  if (u > kRounding || kRight - u >= limit || d.x() < -kRounding) {
    return {};
  }
  const double t = WrapNonNegative(std::atan2(d.x(), -d.y()));
  const double v = WrapNonPositive(t + kRight - goal.yaw);
  return v <= kRounding ? With(t, u, v, kRight) : Sweeps{};
}

/// Equation 8.11 gives the Reeds-Shepp word L+R-S-L-R+, whose second and fourth arcs are right
/// angles.
Sweeps LRSLR(const CurveGoal& goal, double limit) {
  const Vec2 d = ToRightCenter(goal);
  const double square = d.squaredNorm() - 4.0;
  const double u = 4.0 - Root(square);
  if (u > kRounding || 2.0 * kRight - u >= limit) {
    return {};
  }
  const double t = WrapNonNegative(
      std::atan2((4.0 - u) * d.x() - 2.0 * d.y(), -2.0 * d.x() + (u - 4.0) * d.y()));
  const double v = WrapNonNegative(t - goal.yaw);
  return t >= -kRounding && v >= -kRounding ? With(t, u, v, 2.0 * kRight) : Sweeps{};
}

/// Expression for the sweep of a piece in terms of the sweeps t, u and v of its word.
enum class Part : signed char { kT, kU, kMinusU, kV, kMinusRight };

struct Family {
  Sweeps (*solve)(const CurveGoal&, double limit);
  int count;
  std::array<Bend, 5> bends;
  std::array<Part, 5> parts;
  bool is_asymmetric;  ///< whether the opposite order of the pieces is a different word
};

constexpr Bend kL = Bend::kLeft;
constexpr Bend kS = Bend::kNone;
constexpr Bend kR = Bend::kRight;

constexpr std::array<Family, 8> kFamilies{{
    {LSL, 3, {kL, kS, kL}, {Part::kT, Part::kU, Part::kV}, false},
    {LSR, 3, {kL, kS, kR}, {Part::kT, Part::kU, Part::kV}, false},
    {LRL, 3, {kL, kR, kL}, {Part::kT, Part::kU, Part::kV}, true},
    {LRLR, 4, {kL, kR, kL, kR}, {Part::kT, Part::kU, Part::kMinusU, Part::kV}, false},
    {LRLRInner, 4, {kL, kR, kL, kR}, {Part::kT, Part::kU, Part::kU, Part::kV}, false},
    {LRSL, 4, {kL, kR, kS, kL}, {Part::kT, Part::kMinusRight, Part::kU, Part::kV}, true},
    {LRSR, 4, {kL, kR, kS, kR}, {Part::kT, Part::kMinusRight, Part::kU, Part::kV}, true},
    {LRSLR,
     5,
     {kL, kR, kS, kL, kR},
     {Part::kT, Part::kMinusRight, Part::kU, Part::kMinusRight, Part::kV},
     false},
}};

/// A Reeds-Shepp word: its family, its sweeps, and the symmetries applied to the base word.
struct Word {
  const Family* family = nullptr;
  bool mirrored = false;
  bool reversed = false;
  bool is_asymmetric = false;
  Sweeps sweeps;
};

double PartSweep(Part part, const Sweeps& sweeps) {
  switch (part) {
    case Part::kT:
      return sweeps.t;
    case Part::kU:
      return sweeps.u;
    case Part::kMinusU:
      return -sweeps.u;
    case Part::kV:
      return sweeps.v;
    case Part::kMinusRight:
      return -kRight;
  }
  return 0.0;
}

ShortestCurve MakeCurve(const Word& word, double radius) {
  ShortestCurve curve{.radius = radius,
                      .pieces = {},
                      .count = word.family->count,
                      .length = radius * word.sweeps.sum};
  const auto count = static_cast<std::size_t>(curve.count);
  for (std::size_t i = 0; i < count; ++i) {
    const int bend = static_cast<int>(word.family->bends[i]);
    const double sweep = PartSweep(word.family->parts[i], word.sweeps);
    curve.pieces[word.is_asymmetric ? count - 1 - i : i] = {
        static_cast<Bend>(word.mirrored ? -bend : bend), word.reversed ? -sweep : sweep};
  }
  return curve;
}

/// Calls `take` with every Reeds-Shepp word shorter than `limit()`; each call of `take` may lower
/// the limit.
template <typename Limit, typename Take>
void ForEachWord(const CurveGoal& goal, const Limit& limit, const Take& take) {
  const std::array<CurveGoal, 4> seen{goal, goal.Reversed(), goal.Mirrored(),
                                      goal.Mirrored().Reversed()};
  const std::array<CurveGoal, 4> from_end{seen[0].FromGoal(), seen[1].FromGoal(),
                                          seen[2].FromGoal(), seen[3].FromGoal()};
  for (const Family& family : kFamilies) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (const bool is_asymmetric : {false, true}) {
        if (is_asymmetric && !family.is_asymmetric) {
          continue;
        }
        const Sweeps sweeps = family.solve(is_asymmetric ? from_end[i] : seen[i], limit());
        if (sweeps.sum < limit()) {
          take(Word{&family, i >= 2, i % 2 == 1, is_asymmetric, sweeps});
        }
      }
    }
  }
}

Word ShortestWord(const CurveGoal& goal) {
  Word best;
  ForEachWord(
      goal, [&] { return best.sweeps.sum; }, [&](const Word& word) { best = word; });
  return best;
}

}  // namespace

ShortestCurve ReedsShepp(const Pose2& from, const Pose2& to, double radius) {
  return MakeCurve(ShortestWord(CurveGoal(from, to, radius)), radius);
}

double ReedsSheppLength(const Pose2& from, const Pose2& to, double radius) {
  return radius * ShortestWord(CurveGoal(from, to, radius)).sweeps.sum;
}

std::vector<ShortestCurve> ReedsSheppWords(const Pose2& from, const Pose2& to, double radius) {
  std::vector<ShortestCurve> words;
  ForEachWord(
      CurveGoal(from, to, radius), [] { return kNone; },
      [&](const Word& word) { words.push_back(MakeCurve(word, radius)); });
  std::stable_sort(words.begin(), words.end(), [](const ShortestCurve& a, const ShortestCurve& b) {
    return a.length < b.length;
  });
  return words;
}

}  // namespace trackbed
