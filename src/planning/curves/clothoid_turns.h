#pragma once

#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/curves/continuous_curvature.h"

/// Turns of continuous curvature, in units of the smallest radius r.
namespace trackbed {

inline constexpr double kNoCurve = std::numeric_limits<double>::infinity();

/// Tolerance of angles and lengths: a value this close to a limit counts as being on the limit.
inline constexpr double kTurnRounding = 1e-12;

/// Wraps an angle to [0, 2 pi); an angle that equals 2 pi up to rounding becomes 0.
inline double WrapPositive(double angle) {
  constexpr double kCircle = 2.0 * kPi;
  const bool is_wrapped = angle >= 0.0 && angle < kCircle;
  const double wrapped = is_wrapped ? angle : angle - kCircle * std::floor(angle / kCircle);
  return wrapped > kCircle - kTurnRounding ? 0.0 : wrapped;
}

/// Returns the end of a clothoid that begins at the origin with curvature 0, and whose curvature
/// changes to `curvature` at the rate `sharpness`. For a negative curvature, the clothoid is driven
/// backwards, so that the curvature always grows along the heading.
Vec2 ClothoidTo(double curvature, double sharpness);

/// Returns the circle for the largest sharpness `sharpness`, in 1/r^2.
TurnCircle MakeTurnCircle(double sharpness);

/// A way to leave a state: a clothoid to the curvature 0, or no clothoid, and then a turn to one
/// side. To arrive at a state, the car drives the same curve in the opposite direction.
struct TurnEnd {
  int side = 1;       // +1: to the left
  int direction = 1;  // of motion on the turn, away from the state
  Vec2 center{0, 0};  // of the turn's circle
  double yaw = 0.0;   // heading where the turn's clothoid has curvature 0, even if before the state
  Vec2 ahead{1, 0};   // direction of motion at this point, away from the state
  double state = 0.0;        // curvature at the state
  double begin = 0.0;        // curvature where the turn begins, 0 or on the side of the turn
  double before = 0.0;       // length of the clothoid from the state to `begin`
  int before_direction = 1;  // of motion on this clothoid
  double ramp = 0.0;         // length of the turn's clothoid to the full curvature

  [[nodiscard]] int rotation() const { return side * direction; }
  [[nodiscard]] bool from_zero() const { return begin == 0.0; }
  /// Least length of the turn.
  [[nodiscard]] double Least() const { return before + (from_zero() ? 0.0 : ramp); }
};

/// Returns the way to leave `state` that changes the curvature to the full curvature of `side`.
TurnEnd LeaveDirectly(const TurnCircle& circle, const CurveState& state, int side, int direction);

/// Returns the state after a clothoid from `state` to the curvature `curvature`.
CurveState After(const TurnCircle& circle, const CurveState& state, double curvature,
                 int direction);

/// Returns the way to leave `state` that first changes the curvature to `begin` in the direction
/// `before_direction`, then turns to `side`.
TurnEnd LeaveAfter(const TurnCircle& circle, const CurveState& state, double begin,
                   int before_direction, int side, int direction);

/// A turn with two ends.
struct ClothoidTurn {
  double length = kNoCurve;  // Length of the clothoids and the arc.
  double arc = 0.0;          // Length of the arc, negative against the turn's direction.
  double peak = 1.0;         // Magnitude of the curvature of the arc.
  double sharpness = 1.0;    // Sharpness of the clothoids; 0: the turn is a straight.
};

/// Which ends of a turn have the curvature 0. An end of the turn without curvature 0 has the full
/// curvature.
struct ZeroEnds {
  bool first = true;
  bool last = true;
};

/// Returns the turn from a state to the heading `yaw`, with curvature 0 or the full curvature. If
/// `both_ways`, the arc may be driven against the direction of the clothoids where it is shorter.
/// The arc keeps the direction of the clothoids if the turn ends with the full curvature, because
/// the next piece continues this arc.
ClothoidTurn TurnFrom(const TurnCircle& circle, const TurnEnd& end, double yaw, bool to_zero,
                      bool both_ways);

/// Returns the turn by `deflection`, which counts in the direction of rotation [rad].
ClothoidTurn TurnBetween(const TurnCircle& circle, double deflection, ZeroEnds zero,
                         bool both_ways);

/// Returns a lower bound of the length of a turn, without solving the clothoids of a small turn. A
/// turn by the angle a with two ends of curvature 0 has at least the length 2 sqrt(a/sigma).
double LeastTurnFrom(const TurnCircle& circle, const TurnEnd& end, double yaw, bool to_zero,
                     bool both_ways);
double LeastTurnBetween(const TurnCircle& circle, double deflection, ZeroEnds zero, bool both_ways);

}  // namespace trackbed
