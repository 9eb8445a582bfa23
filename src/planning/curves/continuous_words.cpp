#include "src/planning/curves/continuous_words.h"

namespace trackbed {
namespace {

/// Returns the clothoid between a state and the turn that follows the state.
CurvePiece ClothoidBefore(const TurnCircle& circle, const TurnEnd& end) {
  return {.bend = end.state + end.begin < 0.0 ? Bend::kRight : Bend::kLeft,
          .ramps = {.first = end.state,
                    .peak = end.begin,
                    .last = end.begin,
                    .sharpness = circle.sharpness,
                    .direction = end.before_direction}};
}

/// The piece as driven in the opposite direction.
CurvePiece Reversed(CurvePiece piece) {
  std::swap(piece.ramps.first, piece.ramps.last);
  piece.ramps.direction = -piece.ramps.direction;
  piece.sweep = -piece.sweep;
  return piece;
}

CurvePiece TurnPiece(const ClothoidTurn& turn, int side, int direction, double first, double last) {
  if (turn.sharpness == 0.0) {
    return {.bend = Bend::kNone, .sweep = direction * turn.arc};
  }
  return {.bend = side > 0 ? Bend::kLeft : Bend::kRight,
          .sweep = direction * turn.arc,
          .ramps = {.first = first,
                    .peak = side * turn.peak,
                    .last = last,
                    .sharpness = turn.sharpness,
                    .direction = direction}};
}

/// Returns the turn that begins at the state of `end` and ends at the junction with the next turn
/// or straight. For the last turn of a turn sequence, the caller reverses the result.
CurvePiece EndPiece(const TurnCircle& circle, const TurnEnd& end, const TurnJunction& junction,
                    bool to_zero, bool both_ways) {
  const ClothoidTurn turn = TurnFrom(circle, end, junction.yaw, to_zero, both_ways);
  return TurnPiece(turn, end.side, end.direction, end.begin, to_zero ? 0.0 : end.side);
}

/// Deflection of a turn between two junctions, and the curvatures at its ends.
struct MiddleTurn {
  double deflection = 0.0;
  ZeroEnds zero;

  MiddleTurn(const TurnChain& chain, std::size_t i)
      : deflection(chain.side[i] * chain.direction[i] *
                   (chain.junctions[i].yaw - chain.junctions[i - 1].yaw)),
        zero{chain.junctions[i - 1].zero_after, chain.junctions[i].zero_before} {}
};

}  // namespace

double ChainLength(const TurnCircle& circle, const TurnChain& chain, bool both_ways, double limit) {
  const auto last = static_cast<std::size_t>(chain.turns - 1);
  const TurnJunction& begin = chain.junctions[0];
  const TurnJunction& end = chain.junctions[last - 1];
  double straights = chain.lead_in + chain.lead_out;
  for (std::size_t i = 0; i < last; ++i) {
    straights += chain.junctions[i].straight;
  }
  // Check lower bounds first, because they reject most chains of turns without solving the
  // clothoids of small turns.
  double least = straights + chain.first->Least() + chain.last->Least();
  for (std::size_t i = 1; i < last && least < limit; ++i) {
    const MiddleTurn turn(chain, i);
    least += LeastTurnBetween(circle, turn.deflection, turn.zero, both_ways);
  }
  if (least < limit) {
    least += LeastTurnFrom(circle, *chain.first, begin.yaw, begin.zero_before, both_ways) -
             chain.first->Least();
  }
  if (least < limit) {
    least += LeastTurnFrom(circle, *chain.last, end.yaw, end.zero_after, both_ways) -
             chain.last->Least();
  }
  if (least >= limit) {
    return kNoCurve;
  }
  double length = straights +
                  TurnFrom(circle, *chain.first, begin.yaw, begin.zero_before, both_ways).length +
                  TurnFrom(circle, *chain.last, end.yaw, end.zero_after, both_ways).length;
  for (std::size_t i = 1; i < last; ++i) {
    const MiddleTurn turn(chain, i);
    length += TurnBetween(circle, turn.deflection, turn.zero, both_ways).length;
  }
  return length;
}

ShortestCurve ChainCurve(const TurnCircle& circle, const TurnChain& chain, bool both_ways) {
  ShortestCurve curve{.length = chain.length};
  const auto is_straight = [](const CurvePiece& piece) {
    return piece.bend == Bend::kNone && piece.ramps.sharpness == 0.0;
  };
  const auto add = [&](const CurvePiece& piece) {
    if (curve.count > 0 && is_straight(piece)) {
      CurvePiece& last = curve.pieces[static_cast<std::size_t>(curve.count - 1)];
      if (is_straight(last) && last.sweep * piece.sweep > 0.0) {
        last.sweep += piece.sweep;
        return;
      }
    }
    curve.pieces[static_cast<std::size_t>(curve.count++)] = piece;
  };
  const auto last = static_cast<std::size_t>(chain.turns - 1);
  if (chain.first->before > 0.0) {
    add(ClothoidBefore(circle, *chain.first));
  }
  if (chain.lead_in > 0.0) {
    add({.bend = Bend::kNone, .sweep = chain.first->direction * chain.lead_in});
  }
  add(EndPiece(circle, *chain.first, chain.junctions[0], chain.junctions[0].zero_before,
               both_ways));
  for (std::size_t i = 0; i < last; ++i) {
    const TurnJunction& junction = chain.junctions[i];
    if (i > 0) {
      const int side = chain.side[i];
      const MiddleTurn turn(chain, i);
      add(TurnPiece(TurnBetween(circle, turn.deflection, turn.zero, both_ways), side,
                    chain.direction[i], chain.junctions[i - 1].zero_after ? 0.0 : side,
                    junction.zero_before ? 0.0 : side));
    }
    if (junction.straight > 0.0) {
      add({.bend = Bend::kNone, .sweep = junction.direction * junction.straight});
    }
  }
  add(Reversed(EndPiece(circle, *chain.last, chain.junctions[last - 1],
                        chain.junctions[last - 1].zero_after, both_ways)));
  if (chain.lead_out > 0.0) {
    add({.bend = Bend::kNone, .sweep = -chain.last->direction * chain.lead_out});
  }
  if (chain.last->before > 0.0) {
    add(Reversed(ClothoidBefore(circle, *chain.last)));
  }
  return curve;
}

ChainFinder::ChainFinder(const TurnCircle& circle, CurveMotion motion)
    : circle_(circle),
      motion_(motion),
      radius_(std::hypot(circle.along, circle.across)),
      mu_(std::atan2(circle.along, circle.across)),
      cusp_link_(motion == CurveMotion::kHybrid ? 2.0 : 2.0 * circle.across) {}

}  // namespace trackbed
