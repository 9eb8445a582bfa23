#include "src/planning/curves/sharp_turns.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "src/planning/curves/clothoid.h"

namespace trackbed {
namespace {

/// A turn between curvatures of 0.
struct ZeroTurn {
  double along = 0.0;   // from its start to its end, along the heading of the end
  double across = 0.0;  // the same across this heading, positive outside of the turn
  double length = 0.0;
};

/// The turn by a >= 0, with the cosine and sine of a/2.
ZeroTurn TurnByAngle(const TurnCircle& circle, double a, double cos, double sin) {
  ZeroTurn turn;
  double chord = 0.0;
  if (a < 2.0 * circle.least) {
    turn.length = 2.0 * std::sqrt(a / circle.sharpness);
    chord = turn.length * ChordPerLength(0.5 * a);
  } else {
    turn.length = 2.0 / circle.sharpness + a - 2.0 * circle.least;
    chord = 2.0 * (circle.across * sin + circle.along * cos);
  }
  turn.along = chord * cos;
  turn.across = chord * sin;
  return turn;
}

/// One end of a word: a forward turn between a state and curvature 0.
class SharpEnd {
 public:
  /// Makes the first turn (`order` +1) or the last turn (`order` -1).
  SharpEnd(const TurnCircle& circle, const CurveState& state, int order)
      : state_(state.curvature), order_(order) {
    const double turned = 0.5 * state_ * state_ / circle.sharpness;
    neutral_ = state.pose.yaw + order * std::copysign(turned, state_);
    for (const int side : {-1, 1}) {
      // The point at which the curvature is 0 on the clothoid to `side`.
      Side& own = sides_[side < 0 ? 0 : 1];
      own.side = side;
      own.yaw = state.pose.yaw - order * side * turned;
      own.half = Direction(0.5 * own.yaw);
      const Vec2 done = ClothoidTo(side * state_, circle.sharpness);
      const Vec2 ahead = order * Direction(own.yaw);
      own.zero =
          state.pose.position() - done.x() * ahead - done.y() * side * order * LeftNormal(ahead);
      own.done = side * state_ / circle.sharpness;
    }
  }

  struct Side {
    int side = 1;
    Vec2 zero{0, 0};    // position where the curvature is 0
    double yaw = 0.0;   // heading there
    Vec2 half{1, 0};    // direction of half this heading
    double done = 0.0;  // length of the clothoid from there to the state
  };

  /// Returns the side of a turn between the state and the heading alpha.
  [[nodiscard]] const Side& SideFor(double alpha) const {
    return sides_[order_ * (alpha - neutral_) < 0.0 ? 0 : 1];
  }
  /// Returns the deflection from the curvature 0.
  [[nodiscard]] double Deflection(const Side& side, double alpha) const {
    return std::max(order_ * side.side * (alpha - side.yaw), 0.0);
  }
  /// Returns the turn between curvature 0 and the heading alpha; `half` is the direction of
  /// alpha/2.
  [[nodiscard]] ZeroTurn Turn(const TurnCircle& circle, const Side& side, double alpha,
                              const Vec2& half) const {
    return TurnByAngle(circle, Deflection(side, alpha), half.dot(side.half),
                       order_ * side.side * Cross(side.half, half));
  }
  /// Heading alpha of a turn that only straightens the wheels.
  [[nodiscard]] double neutral() const { return neutral_; }

  [[nodiscard]] CurvePiece Piece(const TurnCircle& circle, double alpha) const {
    const Side& side = SideFor(alpha);
    const double a = Deflection(side, alpha);
    const bool is_small = a < 2.0 * circle.least;
    const double peak = is_small ? std::sqrt(a * circle.sharpness) : 1.0;
    return {.bend = side.side < 0 ? Bend::kRight : Bend::kLeft,
            .sweep = is_small ? 0.0 : a - 2.0 * circle.least,
            .ramps = {.first = order_ > 0 ? state_ : 0.0,
                      .peak = side.side * std::min(peak, 1.0),
                      .last = order_ > 0 ? 0.0 : state_,
                      .sharpness = circle.sharpness}};
  }

 private:
  double state_;
  int order_;
  double neutral_ = 0.0;
  std::array<Side, 2> sides_{};
};

/// The words to a goal whose heading is not wrapped, as functions of alpha.
class SharpWords {
 public:
  SharpWords(const TurnCircle& circle, double start, const CurveState& goal)
      : circle_(circle), first_(circle, {{}, start}, 1), last_(circle, goal, -1) {}

  struct Word {
    double across = 0.0;    // f
    double straight = 0.0;  // length of the straight
    double length = 0.0;    // of the word
  };

  [[nodiscard]] Word At(double alpha) const { return At(alpha, Direction(0.5 * alpha)); }

  /// As above, with the direction of alpha/2.
  [[nodiscard]] Word At(double alpha, const Vec2& half) const {
    const SharpEnd::Side& first = first_.SideFor(alpha);
    const SharpEnd::Side& last = last_.SideFor(alpha);
    const ZeroTurn before = first_.Turn(circle_, first, alpha, half);
    const ZeroTurn after = last_.Turn(circle_, last, alpha, half);
    const Vec2 ahead(half.x() * half.x() - half.y() * half.y(), 2.0 * half.x() * half.y());
    const Vec2 apart = last.zero - first.zero;
    Word word;
    word.straight = ahead.dot(apart) - before.along - after.along;
    word.across = Cross(ahead, apart) + first.side * before.across - last.side * after.across;
    word.length = word.straight + before.length - first.done + after.length - last.done;
    return word;
  }

  /// Returns the ends of the interval in which neither turn makes a loop, and the values of alpha
  /// between them at which a turn changes its side, in order.
  [[nodiscard]] std::array<double, 4> Knots() const {
    const double low = std::min(first_.neutral(), last_.neutral());
    const double high = std::max(first_.neutral(), last_.neutral());
    return {high - kPi, low, high, low + kPi};
  }

  /// Returns the zero of a member of Word between `from` and `to`, where it has different signs.
  template <typename Member>
  [[nodiscard]] double Zero(Member member, double from, double to, double at_from,
                            double at_to) const {
    std::uintmax_t most = 60;
    const auto zero = boost::math::tools::toms748_solve(
        [&](double alpha) { return At(alpha).*member; }, from, to, at_from, at_to,
        boost::math::tools::eps_tolerance<double>(52), most);
    return 0.5 * (zero.first + zero.second);
  }

  [[nodiscard]] ShortestCurve Curve(double alpha) const {
    const Word word = At(alpha);
    ShortestCurve curve{.count = 3, .length = word.length};
    curve.pieces[0] = first_.Piece(circle_, alpha);
    curve.pieces[1] = {.bend = Bend::kNone, .sweep = std::max(word.straight, 0.0)};
    curve.pieces[2] = last_.Piece(circle_, alpha);
    return curve;
  }

 private:
  const TurnCircle& circle_;
  SharpEnd first_;
  SharpEnd last_;
};

/// Searches alpha for the shortest word. Where the straight has a length >= 0, small turns change f
/// more slowly than the straight does: f' = -u - l/4, where u is the length of the straight and l
/// that of both turns. Therefore f has at most one root in a range of alpha in
/// which the straight has a length >= 0, and this root is near a knot.
class AlphaSearch {
 public:
  AlphaSearch(const SharpWords& words, double limit) : words_(words), limit_(limit) {
    const std::array<double, 4> knots = words.Knots();
    for (std::size_t i = 0; i + 1 < knots.size() && knots[0] < knots[3]; ++i) {
      const double from = std::clamp(knots[i], knots[0], knots[3]);
      const double to = std::clamp(knots[i + 1], knots[0], knots[3]);
      if (from < to) {
        Search(from, to);
      }
    }
  }

  [[nodiscard]] const std::optional<double>& best() const { return best_; }
  [[nodiscard]] double limit() const { return limit_; }

 private:
  struct Node {
    double alpha = 0.0;
    SharpWords::Word word;
  };

  void Search(double from, double to) {
    constexpr double kSpacing = 0.3;  // spacing at which two roots are told apart [rad]
    const double cells = std::ceil((to - from) / kSpacing);
    // The directions of alpha/2 follow by rotation, without trigonometric functions.
    const Vec2 step = Direction(0.5 * (to - from) / cells);
    Vec2 half = Direction(0.5 * from);
    Node before{from, words_.At(from, half)};
    Take(before);
    for (double i = 1.0; i <= cells; i += 1.0) {
      const double alpha = std::lerp(from, to, i / cells);
      half = step.x() * half + step.y() * LeftNormal(half);
      const Node node{alpha, words_.At(alpha, half)};
      SearchCell(before, node);
      before = node;
    }
    Take(before);
  }

  void SearchCell(Node a, Node b) {
    if ((a.word.straight < 0.0) != (b.word.straight < 0.0)) {
      const double alpha = words_.Zero(&SharpWords::Word::straight, a.alpha, b.alpha,
                                       a.word.straight, b.word.straight);
      Node& end = a.word.straight < 0.0 ? a : b;
      end = Node{alpha, words_.At(alpha)};
    }
    if (a.word.across * b.word.across < 0.0) {
      const double alpha =
          words_.Zero(&SharpWords::Word::across, a.alpha, b.alpha, a.word.across, b.word.across);
      Take({alpha, words_.At(alpha)});
    } else {
      Take(a);
      Take(b);
    }
  }

  /// Keeps the word if it is a root and the shortest one.
  void Take(const Node& node) {
    if (std::abs(node.word.across) <= kTurnRounding && node.word.straight >= -kTurnRounding &&
        node.word.length < limit_) {
      limit_ = node.word.length;
      best_ = node.alpha;
    }
  }

  const SharpWords& words_;
  double limit_;
  std::optional<double> best_;
};

}  // namespace

ShortestCurve SharpWord(const TurnCircle& circle, double start, const CurveState& goal,
                        double limit) {
  ShortestCurve best{.length = kNoCurve};
  CurveState end = goal;
  const double yaw = WrapAngle(goal.pose.yaw);
  for (const double turns : {0.0, 2.0 * kPi, -2.0 * kPi}) {
    end.pose.yaw = yaw + turns;
    const SharpWords words(circle, start, end);
    const AlphaSearch search(words, limit);
    if (search.best()) {
      best = words.Curve(*search.best());
      limit = search.limit();
    }
  }
  return best;
}

}  // namespace trackbed
