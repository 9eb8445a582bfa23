#include "src/planning/curves/continuous_words.h"

namespace trackbed {
namespace {

/// The clothoid between a state and the turn behind it.
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

/// The turn between the state of `end` and a junction, as seen from the state.
CurvePiece EndPiece(const TurnCircle& circle, const TurnEnd& end, const TurnJunction& junction,
                    bool to_zero, bool both_ways) {
  const ClothoidTurn turn = TurnFrom(circle, end, junction.yaw, to_zero, both_ways);
  return TurnPiece(turn, end.side, end.direction, end.begin, to_zero ? 0.0 : end.side);
}

ClothoidTurn MiddleTurn(const TurnCircle& circle, const TurnChain& chain, std::size_t i,
                        bool both_ways) {
  const TurnJunction& in = chain.junctions[i - 1];
  const TurnJunction& out = chain.junctions[i];
  return TurnBetween(circle, chain.side[i] * chain.direction[i] * (out.yaw - in.yaw),
                     {in.zero_after, out.zero_before}, both_ways);
}

}  // namespace

double ChainLength(const TurnCircle& circle, const TurnChain& chain, bool both_ways, double limit) {
  const auto last = static_cast<std::size_t>(chain.turns - 1);
  double length = chain.last->Least();
  for (std::size_t i = 0; i < last; ++i) {
    length += chain.junctions[i].straight;
  }
  length += TurnFrom(circle, *chain.first, chain.junctions[0].yaw, chain.junctions[0].zero_before,
                     both_ways)
                .length;
  for (std::size_t i = 1; i < last && length < limit; ++i) {
    length += MiddleTurn(circle, chain, i, both_ways).length;
  }
  if (length >= limit) {
    return kNoCurve;
  }
  const TurnJunction& end = chain.junctions[last - 1];
  return length - chain.last->Least() +
         TurnFrom(circle, *chain.last, end.yaw, end.zero_after, both_ways).length;
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
  add(EndPiece(circle, *chain.first, chain.junctions[0], chain.junctions[0].zero_before,
               both_ways));
  for (std::size_t i = 0; i < last; ++i) {
    const TurnJunction& junction = chain.junctions[i];
    if (i > 0) {
      const int side = chain.side[i];
      add(TurnPiece(MiddleTurn(circle, chain, i, both_ways), side, chain.direction[i],
                    chain.junctions[i - 1].zero_after ? 0.0 : side,
                    junction.zero_before ? 0.0 : side));
    }
    if (junction.straight > 0.0) {
      add({.bend = Bend::kNone, .sweep = junction.direction * junction.straight});
    }
  }
  add(Reversed(EndPiece(circle, *chain.last, chain.junctions[last - 1],
                        chain.junctions[last - 1].zero_after, both_ways)));
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
