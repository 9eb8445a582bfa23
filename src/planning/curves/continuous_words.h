#pragma once

#include <array>

#include "src/planning/curves/clothoid_turns.h"

/// The words (sequences of two to four turns) of continuous curvature, in units of the smallest
/// radius.
namespace trackbed {

/// Least length of a straight between two cusps; shorter path pieces would be left out.
inline constexpr double kMinStraight = 1e-11;

/// Abilities of the car at a cusp.
enum class CurveMotion {
  kForwards,    ///< The car never drives backwards.
  kContinuous,  ///< The curvature is continuous at cusps.
  kHybrid,      ///< The curvature steps at cusps.
};

/// The junction between two turns: a straight, possibly of length 0.
struct TurnJunction {
  double yaw = 0.0;         // Heading of the car [rad].
  bool zero_before = true;  // Whether the turn before the straight ends at curvature 0.
  bool zero_after = true;   // Whether the turn after the straight starts at curvature 0.
  double straight = 0.0;    // Length of the straight.
  int direction = 1;        // Direction of motion on the straight.
};

/// A chain of turns. The first turn leaves a state, and the last turn arrives at another state.
struct TurnChain {
  const TurnEnd* first = nullptr;
  const TurnEnd* last = nullptr;  // Last turn, driven from the goal in the opposite direction.
  int turns = 2;
  std::array<int, 4> side{};
  std::array<int, 4> direction{};
  std::array<TurnJunction, 3> junctions{};
  double lead_in = 0.0;   // length of a straight before the first turn, if that begins straight
  double lead_out = 0.0;  // length of a straight behind the last turn
  double length = kNoCurve;
};

/// Returns the length of a chain of turns: solves each turn and adds the lengths, until the sum
/// exceeds `limit`.
double ChainLength(const TurnCircle& circle, const TurnChain& chain, bool both_ways, double limit);

/// Returns the path pieces of a chain of turns.
ShortestCurve ChainCurve(const TurnCircle& circle, const TurnChain& chain, bool both_ways);

/// Finds the chains of turns between a given first turn and a given last turn.
class ChainFinder {
 public:
  ChainFinder(const TurnCircle& circle, CurveMotion motion);

  /// Calls `take` with each chain of turns from a turn of `firsts` to a turn of `lasts` that is
  /// shorter than `limit()`. Chains of turns with a straight come first, because chains without a
  /// straight are seldom shorter.
  template <typename Ends, typename Limit, typename Take>
  void Find(const Ends& firsts, const Ends& lasts, const Limit& limit, const Take& take) const {
    const auto consider = [&](TurnChain& chain) {
      chain.length = ChainLength(circle_, chain, both_ways(), limit());
      if (chain.length < limit()) {
        take(chain);
      }
    };
    for (const TurnEnd& first : firsts) {
      for (const TurnEnd& last : lasts) {
        const Centers centers(first, last);
        OfOneTurn(centers, consider);
        WithStraight(centers, limit, consider);
      }
    }
    for (const TurnEnd& first : firsts) {
      for (const TurnEnd& last : lasts) {
        if (first.Least() + last.Least() < limit()) {
          OfTurns(Centers(first, last), consider);
          BesideStraight(Centers(first, last), limit, consider);
        }
      }
    }
  }

 private:
  /// The line from the center of the first turn to the center of the last turn.
  struct Centers {
    Centers(const TurnEnd& from, const TurnEnd& to)
        : first(from), last(to), line(to.center - from.center), square(line.squaredNorm()) {}
    const TurnEnd& first;
    const TurnEnd& last;
    Vec2 line;
    double square;
  };

  [[nodiscard]] bool both_ways() const { return motion_ != CurveMotion::kForwards; }

  template <typename Consider>
  void OfOneTurn(const Centers& centers, const Consider& consider) const;
  template <typename Limit, typename Consider>
  void WithStraight(const Centers& centers, const Limit& limit, const Consider& consider) const;
  template <typename Consider>
  void OfTurns(const Centers& centers, const Consider& consider) const;
  template <typename Limit, typename Consider>
  void BesideStraight(const Centers& centers, const Limit& limit, const Consider& consider) const;
  template <typename Consider>
  void OfThreeTurns(const Centers& centers, bool first_cusp, bool last_cusp,
                    const Consider& consider) const;
  template <typename Consider>
  void OfFourTurns(const Centers& centers, bool outer_cusps, bool inner_cusp,
                   const Consider& consider) const;

  /// Returns the distance of the centers of two turns that touch.
  [[nodiscard]] double Link(bool cusp) const { return cusp ? cusp_link_ : 2.0 * radius_; }
  /// Returns the place where two turns touch whose centers are in the direction `angle`.
  [[nodiscard]] TurnJunction Touch(double angle, bool cusp, int side, int direction) const;
  [[nodiscard]] static TurnChain Chain(const Centers& centers, int turns);

  TurnCircle circle_;
  CurveMotion motion_;
  double radius_;     // Distance from a turn's center to the points of curvature 0.
  double mu_;         // Angle between heading and circle tangent at curvature 0.
  double cusp_link_;  // Distance of the centers of two turns at a cusp.
};

inline TurnChain ChainFinder::Chain(const Centers& centers, int turns) {
  TurnChain chain{.first = &centers.first, .last = &centers.last, .turns = turns};
  chain.side[0] = centers.first.side;
  chain.direction[0] = centers.first.direction;
  const auto last = static_cast<std::size_t>(turns - 1);
  chain.side[last] = centers.last.side;
  chain.direction[last] = -centers.last.direction;
  return chain;
}

inline TurnJunction ChainFinder::Touch(double angle, bool cusp, int side, int direction) const {
  const bool zero = !cusp || motion_ != CurveMotion::kHybrid;
  return {.yaw = angle + side * (0.5 * kPi) - (cusp ? 0.0 : side * direction * mu_),
          .zero_before = zero,
          .zero_after = zero};
}

/// Finds the single turn that connects two states by an arc of their common circle.
template <typename Consider>
void ChainFinder::OfOneTurn(const Centers& centers, const Consider& consider) const {
  const TurnEnd& a = centers.first;
  const TurnEnd& b = centers.last;
  if (a.side != b.side || a.direction != -b.direction ||
      centers.square > kTurnRounding * kTurnRounding * (1.0 + a.center.squaredNorm())) {
    return;
  }
  TurnChain chain = Chain(centers, 2);
  chain.junctions[0] = {a.yaw + a.rotation() * circle_.least, false, false};
  consider(chain);
}

/// Finds the words (turn sequences) that contain a straight. A turn sequence may have a cusp and a
/// quarter turn at one end of the straight or at both ends. A turn sequence may drive the straight
/// in the direction opposite to a neighboring turn.
template <typename Limit, typename Consider>
void ChainFinder::WithStraight(const Centers& centers, const Limit& limit,
                               const Consider& consider) const {
  const TurnEnd& a = centers.first;
  const TurnEnd& b = centers.last;
  const bool is_hybrid = motion_ == CurveMotion::kHybrid;
  const auto add = [&](int cusp_before, int cusp_after, int direction, int along_sign) {
    const int before = cusp_before != 0 ? -a.direction : a.direction;
    const int after = cusp_after != 0 ? b.direction : -b.direction;
    const int side_before = cusp_before != 0 ? -a.side : a.side;
    const int side_after = cusp_after != 0 ? -b.side : b.side;
    const bool zero_before = before == direction || !is_hybrid;
    const bool zero_after = after == direction || !is_hybrid;
    const double across = side_after * (zero_after ? circle_.across : 1.0) -
                          side_before * (zero_before ? circle_.across : 1.0);
    const double turns =
        (zero_before ? before : 0) * circle_.along + (zero_after ? after : 0) * circle_.along;
    const double square = centers.square - across * across;
    if (square < -kTurnRounding * (1.0 + centers.square)) {
      return;
    }
    double along = along_sign * std::sqrt(std::max(square, 0.0));
    // Two turns that touch need no straight between them. Compare squares, because a square root
    // would amplify the rounding errors.
    if (direction * (along - turns) < 0.0 && along * turns > 0.0 &&
        std::abs(square - turns * turns) <= kTurnRounding * std::sqrt(centers.square)) {
      along = turns;
    }
    const double straight = direction * (along - turns) - (cusp_before + cusp_after) * cusp_link_;
    // Without a straight between two cusps, the curvature would step where the car does not stop.
    const double least =
        zero_before || zero_after ? -kTurnRounding * (1.0 + std::abs(along)) : kMinStraight;
    if (straight < least || straight + a.Least() + b.Least() >= limit()) {
      return;
    }
    const Vec2& d = centers.line;
    const double yaw = std::atan2(d.y() * along - d.x() * across, d.x() * along + d.y() * across);
    TurnChain chain = Chain(centers, 2 + cusp_before + cusp_after);
    std::size_t i = 0;
    if (cusp_before != 0) {
      chain.junctions[i] = {yaw - side_before * before * (0.5 * kPi), !is_hybrid, !is_hybrid};
      chain.side[++i] = side_before;
      chain.direction[i] = before;
    }
    chain.junctions[i] = {yaw, zero_before, zero_after, std::max(straight, 0.0), direction};
    if (cusp_after != 0) {
      chain.side[++i] = side_after;
      chain.direction[i] = after;
      chain.junctions[i] = {yaw + side_after * after * (0.5 * kPi), !is_hybrid, !is_hybrid};
    }
    consider(chain);
  };
  const int from = a.direction;
  const int to = -b.direction;
  if (from == to) {
    add(0, 0, from, from);
    if (both_ways()) {
      add(0, 0, -from, -from);
      add(0, 0, -from, from);
      add(1, 1, -from, -from);
    }
  } else if (both_ways()) {
    add(0, 0, to, to);
    add(0, 0, from, from);
    add(1, 0, to, to);
    add(0, 1, from, from);
  }
}

}  // namespace trackbed

#include "src/planning/curves/continuous_words_of_turns.h"
