#include "src/planning/curves/sharp_turns.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "src/planning/curves/sharp_end.h"

// Finds the shortest curve (word) of a turn, a straight and a turn of continuous curvature, all
// forwards.
// 1. alpha is the heading of the straight. For a given heading alpha of the straight, both turns
//    are known in closed form. The function f(alpha) is the distance between the ends of the turns,
//    measured perpendicular to the straight.
// 2. The words (turn sequences) are the roots of f(alpha) with a straight of length >= 0.
// 3. The interval of the heading alpha is divided where a turn changes its side, and then into
//    cells of 0.3 rad. TOMS 748 finds the root in each cell in which f(alpha) changes its sign.
// 4. Steps 1 to 3 are repeated for the goal's heading plus and minus a full turn.
// Source: Fraichard and Scheuer 2004.
namespace trackbed {
namespace {

/// The curves turn-straight-turn to a goal, as functions of the straight's heading alpha. The
/// interval of alpha is one in which no turn changes its side. The heading of the goal includes
/// full turns.
class SharpWords {
 public:
  SharpWords(const SharpEnd& first, const SharpEnd& last, double from, double to)
      : first_(first),
        last_(last),
        first_side_(first.SideFor(0.5 * (from + to))),
        last_side_(last.SideFor(0.5 * (from + to))),
        apart_(last_side_.zero - first_side_.zero),
        distance_(apart_.norm()),
        done_(first_side_.done + last_side_.done) {
    constexpr double kHalfTurn = kPi + kTurnRounding;
    const auto bends = [&](double alpha) {
      return std::max(first.Deflection(first_side_, alpha), last.Deflection(last_side_, alpha));
    };
    turn_by_at_most_pi_ = bends(from) <= kHalfTurn && bends(to) <= kHalfTurn;
  }

  struct Word {
    double alpha = 0.0;
    Vec2 half{1, 0};                // Direction of alpha/2.
    double across = 0.0;            // Value of f.
    double straight = 0.0;          // Length u of the straight.
    double length = 0.0;            // Length of the word.
    double slope = 0.0;             // Slope -df/d(alpha), approximate for small turns.
    Vec2 apart{0, 0};               // Vector from the first turn to the last, with x along alpha.
    std::array<double, 2> along{};  // Extents of the turns along alpha.
    std::array<double, 2> turns{};  // Lengths of the turns.
  };

  [[nodiscard]] Word At(double alpha) const { return At(alpha, Direction(0.5 * alpha)); }

  /// Returns the curve whose straight has the heading `alpha`; `half` is the direction of alpha/2.
  [[nodiscard]] Word At(double alpha, const Vec2& half) const {
    const ZeroTurn before = first_.Turn(first_side_, alpha, half);
    const ZeroTurn after = last_.Turn(last_side_, alpha, half);
    const Vec2 ahead = DoubleAngle(half);
    Word word{.alpha = alpha,
              .half = half,
              .apart = {ahead.dot(apart_), Cross(ahead, apart_)},
              .along = {before.along, after.along},
              .turns = {before.length, after.length}};
    word.straight = word.apart.x() - before.along - after.along;
    word.across =
        word.apart.y() + first_side_.side * before.across - last_side_.side * after.across;
    word.length = word.straight + before.length + after.length - done_;
    word.slope = word.straight + before.slope + after.slope;
    return word;
  }

  /// Returns an upper bound of the straight's length u for all headings alpha between the curves a
  /// and b. As a function of alpha, the extent of a turn by at most pi is at least 0 and has a
  /// single maximum.
  [[nodiscard]] double MostStraight(const Word& a, const Word& b) const {
    if (!turn_by_at_most_pi_) {
      return kNoCurve;
    }
    const bool has_peak = a.apart.y() > 0.0 && b.apart.y() < 0.0;
    const double most = has_peak ? distance_ : std::max(a.apart.x(), b.apart.x());
    return most - std::min(a.along[0], b.along[0]) - std::min(a.along[1], b.along[1]);
  }

  /// Returns whether the last turn lies behind the first turn for all headings alpha between two
  /// directions at most half a turn apart. For such headings, the straight between the turns would
  /// have a negative length.
  [[nodiscard]] bool AreBehind(const Vec2& from, const Vec2& to) const {
    return turn_by_at_most_pi_ && from.dot(apart_) < 0.0 && to.dot(apart_) < 0.0 &&
           Cross(from, to) >= 0.0;
  }

  /// Returns a lower bound of the curve's length for all headings alpha between the curves a and b.
  [[nodiscard]] double LeastLength(const Word& a, const Word& b) const {
    return std::min(a.turns[0], b.turns[0]) + std::min(a.turns[1], b.turns[1]) - done_;
  }

  /// Returns the same bound for all headings between two headings, without the curves there. A
  /// curve is at least as long as the distance between its ends.
  [[nodiscard]] double LeastLength(double from, double to) const {
    const double turns =
        std::min(first_.Length(first_side_, from), first_.Length(first_side_, to)) +
        std::min(last_.Length(last_side_, from), last_.Length(last_side_, to));
    return std::max(turns, distance_) - done_;
  }

  /// Returns an upper bound of the change of the word's length per change of the straight's heading
  /// alpha. The bound is the distance between the turns, plus the lengths of both turns beyond
  /// their extent in the direction alpha.
  [[nodiscard]] double MostLengthPerAngle() const {
    const auto radius = [](const TurnCircle& circle) {
      return std::hypot(circle.across, circle.along);
    };
    return distance_ + 2.0 + radius(first_.circle()) + radius(last_.circle());
  }

  /// Returns the magnitude below which f(alpha), the lateral distance of both turns, is a rounding
  /// error.
  [[nodiscard]] double rounding() const {
    return 4.0 * std::numeric_limits<double>::epsilon() * (1.0 + distance_);
  }

  [[nodiscard]] ShortestCurve Curve(const Word& word) const {
    ShortestCurve curve{.count = 3, .length = word.length};
    curve.pieces[0] = first_.Piece(first_side_, word.alpha);
    curve.pieces[1] = {.bend = Bend::kNone, .sweep = std::max(word.straight, 0.0)};
    curve.pieces[2] = last_.Piece(last_side_, word.alpha);
    return curve;
  }

 private:
  const SharpEnd& first_;
  const SharpEnd& last_;
  const SharpEnd::Side& first_side_;
  const SharpEnd::Side& last_side_;
  Vec2 apart_;
  double distance_;
  double done_;
  bool turn_by_at_most_pi_ = false;
};

/// Searches for the heading alpha of the straight in the shortest word. Where the straight's length
/// u is at least 0, f falls with alpha: f' = -u - g, with g > 0 due to the turns. In the slope f',
/// a small turn adds a quarter of its length to g, and a full turn adds the constant `along` of its
/// circle. As f falls, it has at most one root in a range of alpha with a straight's length u >= 0.
/// The search halves an interval of alpha until it is small, or until a bound shows that the
/// straight's length u is negative.
class AlphaSearch {
 public:
  AlphaSearch(const SharpWords& words, double limit) : words_(words), limit_(limit) {}

  /// Searches the words from one value of alpha to another.
  void Search(const HalvedAngle& from, const HalvedAngle& to) {
    if (words_.AreBehind(DoubleAngle(from.half), DoubleAngle(to.half))) {
      return;
    }
    const Word a = words_.At(from.angle, from.half);
    const Word b = words_.At(to.angle, to.half);
    Take(a);
    Take(b);
    Split(a, b);
  }

  [[nodiscard]] const std::optional<SharpWords::Word>& best() const { return best_; }
  [[nodiscard]] double limit() const { return limit_; }

 private:
  using Word = SharpWords::Word;

  void Split(const Word& a, const Word& b) {
    constexpr double kSpacing = 0.3;  // Smallest distance of distinct roots [rad].
    const double most = words_.MostStraight(a, b);
    // The function f falls by at most `slope` per angle. If f is too far above 0 at the first
    // angle, or too far below 0 at the last angle, it has no root between these angles.
    const double slope = most + (a.slope - a.straight) + (b.slope - b.straight);
    const double fall = slope * (b.alpha - a.alpha);
    if (most < -kTurnRounding || a.across > fall || -b.across > fall ||
        words_.LeastLength(a, b) >= limit_) {
      return;
    }
    if (b.alpha - a.alpha > kSpacing) {
      const Word middle = words_.At(0.5 * (a.alpha + b.alpha), (a.half + b.half).normalized());
      Take(middle);
      Split(a, middle);
      Split(middle, b);
    } else {
      SearchCell(a, b);
    }
  }

  void SearchCell(const Word& a, const Word& b) {
    const bool is_solved = a.across * b.across < 0.0 && Solve(a, b);
    if (is_solved || (a.straight < 0.0) == (b.straight < 0.0)) {
      return;
    }
    // The function f of alpha falls only on the part of the cell where the straight's length u is
    // >= 0. Between the cell's end with u > 0 and the heading with u = 0, f may have a root even if
    // f has the same sign at both ends of the cell.
    const Word& in = a.straight < 0.0 ? b : a;
    if ((&in == &a ? in.across : -in.across) <= 0.0) {
      return;
    }
    const Word edge = Edge(a, b);
    if (in.across * edge.across < 0.0) {
      &in == &a ? Solve(in, edge) : Solve(edge, in);
    }
  }

  /// Returns the curve between the curves `a` and `b` whose straight has the length u = 0.
  [[nodiscard]] Word Edge(const Word& a, const Word& b) const {
    std::uintmax_t most = 60;
    const auto zero = boost::math::tools::toms748_solve(
        [&](double alpha) { return words_.At(alpha).straight; }, a.alpha, b.alpha, a.straight,
        b.straight, boost::math::tools::eps_tolerance<double>(52), most);
    return words_.At(0.5 * (zero.first + zero.second));
  }

  /// Solves f(alpha) = 0 between the headings of two curves by Newton steps, then secants, and by
  /// bisection where a step leaves the bracket or shrinks it too slowly. Returns false if the
  /// straight has a negative length at the root. Stops early if the curve is longer than the length
  /// limit.
  bool Solve(const Word& a, const Word& b) {
    double low = a.alpha;
    double high = b.alpha;
    double width = high - low;
    const double sign = a.across < 0.0 ? -1.0 : 1.0;
    Word word = std::abs(a.across) < std::abs(b.across) ? a : b;
    double slope = word.slope;
    const double per_angle = words_.MostLengthPerAngle();
    for (int i = 1; i <= kMostSteps; ++i) {
      double next = word.alpha + word.across / slope;
      const bool is_slow = i % 4 == 0 && high - low > 0.25 * width;
      width = i % 4 == 0 ? high - low : width;
      if (is_slow || !(next > low && next < high)) {
        next = 0.5 * (low + high);
      }
      const double step = next - word.alpha;
      if (word.length - 2.0 * std::abs(step) * per_angle >= limit_) {
        return true;
      }
      const Word found = words_.At(next);
      slope = (word.across - found.across) / step;
      word = found;
      if (std::abs(word.across) <= words_.rounding() || next <= low || next >= high) {
        break;
      }
      (sign * word.across > 0.0 ? low : high) = next;
    }
    Take(word);
    return word.straight >= -kTurnRounding;
  }

  /// Keeps the word if it is a root of f(alpha) and the shortest word so far.
  void Take(const Word& word) {
    if (std::abs(word.across) <= kTurnRounding && word.straight >= -kTurnRounding &&
        word.length < limit_) {
      limit_ = word.length;
      best_ = word;
    }
  }

  static constexpr int kMostSteps = 200;

  const SharpWords& words_;
  double limit_;
  std::optional<Word> best_;
};

}  // namespace

ShortestCurve SharpWord(const TurnCircle& circle, double start, const CurveState& goal,
                        double limit) {
  return SharpWord(circle, circle, start, goal, limit);
}

ShortestCurve SharpWord(const TurnCircle& at_start, const TurnCircle& at_goal, double start,
                        const CurveState& goal, double limit) {
  ShortestCurve best{.length = kNoCurve};
  const SharpEnd first(at_start, {{}, start}, 1);
  const Pose2 wrapped{goal.pose.x, goal.pose.y, WrapAngle(goal.pose.yaw)};
  const SharpEnd unwound(at_goal, {wrapped, goal.curvature}, -1);
  for (const int circles : {0, 1, -1}) {
    const SharpEnd last = unwound.Wound(circles);
    // Neither turn makes a loop between the first and the last of these values of alpha. At the
    // values of alpha between these two, a turn changes its side.
    const bool is_left = first.neutral().angle < last.neutral().angle;
    const HalvedAngle low = is_left ? first.neutral() : last.neutral();
    const HalvedAngle high = is_left ? last.neutral() : first.neutral();
    std::array<HalvedAngle, 4> knots{high.Opposite(-1.0), low, high, low.Opposite(1.0)};
    if (knots[0].angle > low.angle) {
      knots[1] = knots[0];
      knots[2] = knots[3];
    }
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      if (knots[i].angle < knots[i + 1].angle) {
        const SharpWords words(first, last, knots[i].angle, knots[i + 1].angle);
        if (words.LeastLength(knots[i].angle, knots[i + 1].angle) >= limit) {
          continue;
        }
        AlphaSearch search(words, limit);
        search.Search(knots[i], knots[i + 1]);
        if (search.best()) {
          best = words.Curve(*search.best());
          limit = search.limit();
        }
      }
    }
  }
  return best;
}

ShortestCurve TwoTurns(double radius, double first_sharpness, double last_sharpness,
                       const CurveState& from, const CurveState& to, double limit) {
  const Vec2 local = ToLocal(from.pose, to.pose.position()) / radius;
  const double square = radius * radius;
  ShortestCurve curve = SharpWord(
      MakeTurnCircle(first_sharpness * square), MakeTurnCircle(last_sharpness * square),
      from.curvature * radius,
      {{local.x(), local.y(), to.pose.yaw - from.pose.yaw}, to.curvature * radius}, limit / radius);
  curve.radius = radius;
  curve.length *= radius;
  return curve;
}

}  // namespace trackbed
