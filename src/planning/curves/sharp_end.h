#pragma once

#include <array>
#include <cmath>

#include "src/planning/curves/clothoid.h"
#include "src/planning/curves/clothoid_turns.h"

/// The turns at both ends of a word turn-straight-turn of the sharpest turns (sharp_turns.h).
namespace trackbed {

/// Returns the direction of twice the angle of a direction.
inline Vec2 DoubleAngle(const Vec2& half) {
  return {half.x() * half.x() - half.y() * half.y(), 2.0 * half.x() * half.y()};
}

/// An angle with the direction of its half, which takes a cosine and a sine to compute.
struct HalvedAngle {
  double angle = 0.0;
  Vec2 half{1, 0};

  /// Returns the angle plus half a turn (`sign` +1) or minus half a turn (`sign` -1).
  [[nodiscard]] HalvedAngle Opposite(double sign) const {
    return {angle + sign * kPi, sign * LeftNormal(half)};
  }
};

/// A turn between curvatures of 0.
struct ZeroTurn {
  double along = 0.0;   // Distance from start to end along the final heading.
  double across = 0.0;  // Distance from start to end across the final heading, positive outward.
  double length = 0.0;
  double slope = 0.0;  // Value of along - d(across)/d(angle), exact for full turns.
};

/// Returns the length of the turn with the deflection a >= 0.
inline double LengthByAngle(const TurnCircle& circle, double a) {
  return a < 2.0 * circle.least ? 2.0 * std::sqrt(a / circle.sharpness)
                                : 2.0 / circle.sharpness + a - 2.0 * circle.least;
}

/// Returns the turn with the deflection a >= 0; `cos` and `sin` are the cosine and sine of a/2.
inline ZeroTurn TurnByAngle(const TurnCircle& circle, double a, double cos, double sin) {
  ZeroTurn turn{.length = LengthByAngle(circle, a)};
  double chord = 0.0;
  if (a < 2.0 * circle.least) {
    turn.slope = 0.25 * turn.length;
    chord = turn.length * ChordPerLength(0.5 * a);
  } else {
    turn.slope = circle.along;
    chord = 2.0 * (circle.across * sin + circle.along * cos);
  }
  turn.along = chord * cos;
  turn.across = chord * sin;
  return turn;
}

/// One end of a curve turn-straight-turn: a forward turn between a state and curvature 0.
class SharpEnd {
 public:
  /// Makes the first turn (`order` +1) or the last turn (`order` -1).
  SharpEnd(const TurnCircle& circle, const CurveState& state, int order);

  struct Side {
    int side = 1;
    Vec2 zero{0, 0};    // Position at which the turn's curvature is 0.
    double yaw = 0.0;   // Heading at which the turn's curvature is 0.
    Vec2 half{1, 0};    // Direction of half the heading `yaw`.
    double done = 0.0;  // Length of the clothoid from `zero` to the state.
  };

  /// Returns the end of the word with `circles` full turns added to its heading: -1, 0 or 1.
  [[nodiscard]] SharpEnd Wound(int circles) const;
  /// Returns the side of a turn between the state and the heading alpha.
  [[nodiscard]] const Side& SideFor(double alpha) const {
    return sides_[order_ * (alpha - neutral_) < 0.0 ? 0 : 1];
  }
  /// Returns the heading change of the turn from the point where its curvature is 0 to its end.
  /// Where a turn changes its side, a tiny deflection is set to 0: the length of a small turn, a
  /// square root of the deflection, would amplify its rounding error.
  [[nodiscard]] double Deflection(const Side& side, double alpha) const {
    const double deflection = order_ * side.side * (alpha - side.yaw);
    const double least = side.done > 0.0 ? 0.0 : kTurnRounding;
    return deflection > least ? deflection : 0.0;
  }
  /// Returns the length of the turn between curvature 0 and the heading alpha.
  [[nodiscard]] double Length(const Side& side, double alpha) const {
    return LengthByAngle(circle_, Deflection(side, alpha));
  }
  /// Returns the turn between curvature 0 and the heading alpha; `half` is the direction of
  /// alpha/2.
  [[nodiscard]] ZeroTurn Turn(const Side& side, double alpha, const Vec2& half) const {
    return TurnByAngle(circle_, Deflection(side, alpha), half.dot(side.half),
                       order_ * side.side * Cross(side.half, half));
  }
  /// Heading change alpha of a turn that only straightens the wheels, with the direction alpha/2.
  [[nodiscard]] HalvedAngle neutral() const {
    return {neutral_, sides_[state_ > 0.0 ? 0 : 1].half};
  }

  [[nodiscard]] CurvePiece Piece(const Side& side, double alpha) const;

  [[nodiscard]] const TurnCircle& circle() const { return circle_; }

 private:
  TurnCircle circle_;
  double state_;
  int order_;
  double neutral_ = 0.0;
  std::array<Side, 2> sides_{};
};

}  // namespace trackbed
