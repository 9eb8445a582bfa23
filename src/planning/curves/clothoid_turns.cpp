#include "src/planning/curves/clothoid_turns.h"

#include <algorithm>

#include "src/planning/curves/clothoid.h"

namespace trackbed {
namespace {

/// Returns the sweep of the arc that turns by `angle`, which counts modulo a full circle.
double ArcFor(double angle, bool both_ways) {
  const double arc = WrapPositive(angle);
  return both_ways && arc > kPi ? arc - 2.0 * kPi : arc;
}

/// A turn with two ends of curvature 0 may be too short for the full curvature. Replaces a turn
/// that is too short by two clothoids between the same ends, if the clothoids are shorter.
void ShortenSmallTurn(const TurnCircle& circle, double deflection, ClothoidTurn& turn) {
  if (deflection >= 2.0 * circle.least) {
    return;
  }
  const double half = 0.5 * deflection;
  const double per_length = ChordPerLength(half);
  const double chord = 2.0 * (std::sin(half) * circle.across + std::cos(half) * circle.along);
  if (per_length <= 0.0 || chord <= 0.0 || chord >= per_length * turn.length) {
    return;
  }
  const double length = chord / per_length;
  const double sharpness = 4.0 * deflection / (length * length);
  const double peak = std::sqrt(deflection * sharpness);
  // The two clothoids end on the same circle as the turn that they replace, so their sharpness is
  // at most the largest one. The two comparisons reject clothoids that are sharper by rounding
  // errors or that wind several times.
  if (sharpness <= circle.sharpness * (1.0 + kTurnRounding) && peak <= 1.0 + kTurnRounding) {
    // Without deflection, the turn is a straight.
    turn = {.length = length,
            .arc = sharpness == 0.0 ? length : 0.0,
            .peak = std::min(peak, 1.0),
            .sharpness = std::min(sharpness, circle.sharpness)};
  }
}

}  // namespace

Vec2 ClothoidTo(double curvature, double sharpness) {
  if (curvature == 0.0) {
    return {0.0, 0.0};
  }
  return curvature / sharpness * FresnelPerLength(0.5 * curvature * curvature / sharpness);
}

TurnCircle MakeTurnCircle(double sharpness) {
  const Vec2 end = ClothoidTo(1.0, sharpness);
  const double least = 0.5 / sharpness;
  return {.sharpness = sharpness,
          .least = least,
          .along = end.x() - std::sin(least),
          .across = end.y() + std::cos(least)};
}

TurnEnd LeaveDirectly(const TurnCircle& circle, const CurveState& state, int side, int direction) {
  const double curvature = side * state.curvature;
  const double turned = 0.5 * curvature * curvature / circle.sharpness;
  TurnEnd end{.side = side, .direction = direction, .state = state.curvature};
  end.yaw = state.pose.yaw - end.rotation() * turned;
  end.ahead = direction * Direction(end.yaw);
  const Vec2 inside = side * direction * LeftNormal(end.ahead);
  const Vec2 done = ClothoidTo(curvature, circle.sharpness);
  end.center = state.pose.position() + (circle.along - done.x()) * end.ahead +
               (circle.across - done.y()) * inside;
  end.begin = curvature <= 0.0 ? 0.0 : state.curvature;
  end.before = end.from_zero() ? -curvature / circle.sharpness : 0.0;
  end.before_direction = direction;
  end.ramp = (end.from_zero() ? 1.0 : 1.0 - curvature) / circle.sharpness;
  return end;
}

CurveState After(const TurnCircle& circle, const CurveState& state, double curvature,
                 int direction) {
  // A clothoid whose curvature decreases is mirrored, so that its curvature grows from u to v.
  const double side = curvature < state.curvature ? -1.0 : 1.0;
  const double u = side * state.curvature;
  const double v = side * curvature;
  const double turned = 0.5 * (v - u) * (v + u) / circle.sharpness;
  const double zero_yaw = state.pose.yaw - side * direction * 0.5 * u * u / circle.sharpness;
  const Vec2 moved = ClothoidTo(v, circle.sharpness) - ClothoidTo(u, circle.sharpness);
  const Vec2 ahead = Direction(zero_yaw);
  const Vec2 at =
      state.pose.position() + direction * moved.x() * ahead + side * moved.y() * LeftNormal(ahead);
  return {{at.x(), at.y(), state.pose.yaw + side * direction * turned}, curvature};
}

TurnEnd LeaveAfter(const TurnCircle& circle, const CurveState& state, double begin,
                   int before_direction, int side, int direction) {
  TurnEnd end =
      LeaveDirectly(circle, After(circle, state, begin, before_direction), side, direction);
  end.state = state.curvature;
  end.begin = begin;
  end.before = std::abs(begin - state.curvature) / circle.sharpness;
  end.before_direction = before_direction;
  return end;
}

ClothoidTurn TurnBetween(const TurnCircle& circle, double deflection, ZeroEnds zero,
                         bool both_ways) {
  const int ramps = (zero.first ? 1 : 0) + (zero.last ? 1 : 0);
  const double turned = WrapPositive(deflection);
  ClothoidTurn turn{.arc = ArcFor(turned - ramps * circle.least, both_ways && ramps == 2),
                    .sharpness = circle.sharpness};
  turn.length = ramps / circle.sharpness + std::abs(turn.arc);
  if (ramps == 2) {
    ShortenSmallTurn(circle, turned, turn);
  }
  return turn;
}

double LeastTurnBetween(const TurnCircle& circle, double deflection, ZeroEnds zero,
                        bool both_ways) {
  const int ramps = (zero.first ? 1 : 0) + (zero.last ? 1 : 0);
  const double turned = WrapPositive(deflection);
  if (ramps == 2 && turned < 2.0 * circle.least) {
    return 2.0 * std::sqrt(turned / circle.sharpness);
  }
  const double arc = ArcFor(turned - ramps * circle.least, both_ways && ramps == 2);
  return ramps / circle.sharpness + std::abs(arc);
}

double LeastTurnFrom(const TurnCircle& circle, const TurnEnd& end, double yaw, bool to_zero,
                     bool both_ways) {
  if (end.from_zero()) {
    return end.before +
           LeastTurnBetween(circle, end.rotation() * (yaw - end.yaw), {true, to_zero}, both_ways);
  }
  return TurnFrom(circle, end, yaw, to_zero, both_ways).length;
}

ClothoidTurn TurnFrom(const TurnCircle& circle, const TurnEnd& end, double yaw, bool to_zero,
                      bool both_ways) {
  const double deflection = end.rotation() * (yaw - end.yaw);
  ClothoidTurn turn;
  if (end.from_zero()) {
    turn = TurnBetween(circle, deflection, {true, to_zero}, both_ways);
  } else {
    turn.sharpness = circle.sharpness;
    turn.arc = ArcFor(deflection - (to_zero ? 2.0 : 1.0) * circle.least, both_ways && to_zero);
    turn.length = end.ramp + std::abs(turn.arc) + (to_zero ? 1.0 / circle.sharpness : 0.0);
  }
  turn.length += end.before;
  return turn;
}

}  // namespace trackbed
