#pragma once

#include "src/planning/curves/continuous_words.h"

/// The words without a straight between their turns, for continuous_words.h.
namespace trackbed {

template <typename Consider>
void ChainFinder::OfTurns(const Centers& centers, const Consider& consider) const {
  const bool same_side = centers.first.side == centers.last.side;
  const bool same_direction = centers.first.direction == -centers.last.direction;
  if (same_side) {
    if (same_direction) {
      OfThreeTurns(centers, false, false, consider);
      if (both_ways()) {
        OfThreeTurns(centers, true, true, consider);
      }
    } else if (both_ways()) {
      OfThreeTurns(centers, true, false, consider);
      OfThreeTurns(centers, false, true, consider);
    }
  } else if (same_direction) {
    OfFourTurns(centers, false, false, consider);
    if (both_ways()) {
      OfFourTurns(centers, true, false, consider);
    }
  } else if (both_ways()) {
    OfFourTurns(centers, false, true, consider);
  }
}

/// Finds the words of two turns that touch, with a straight before the first turn or behind the
/// last turn. The straight moves the center of its turn, and the distance of both centers is a
/// quadratic function of the length of the straight.
template <typename Limit, typename Consider>
void ChainFinder::BesideStraight(const Centers& centers, const Limit& limit,
                                 const Consider& consider) const {
  const TurnEnd& a = centers.first;
  const TurnEnd& b = centers.last;
  const bool has_cusp = a.direction == b.direction;
  if (a.side == b.side || (has_cusp && !both_ways())) {
    return;
  }
  const double link = Link(has_cusp);
  for (const bool is_first : {true, false}) {
    const TurnEnd& end = is_first ? a : b;
    if (!end.from_zero()) {
      continue;
    }
    const Vec2 ahead = is_first ? end.ahead : Vec2(-end.ahead);
    const double along = centers.line.dot(ahead);
    const double across = Cross(ahead, centers.line);
    const double square = link * link - across * across;
    if (square < 0.0) {
      continue;
    }
    for (const double sign : {-1.0, 1.0}) {
      const double straight = along + sign * std::sqrt(square);
      if (straight < 0.0 || straight + a.Least() + b.Least() >= limit()) {
        continue;
      }
      const Vec2 line = centers.line - straight * ahead;
      TurnChain chain = Chain(centers, 2);
      (is_first ? chain.lead_in : chain.lead_out) = straight;
      chain.junctions[0] =
          Touch(std::atan2(line.y(), line.x()), has_cusp, chain.side[0], chain.direction[0]);
      consider(chain);
    }
  }
}

template <typename Consider>
void ChainFinder::OfThreeTurns(const Centers& centers, bool first_cusp, bool last_cusp,
                               const Consider& consider) const {
  const double one = Link(first_cusp);
  const double two = Link(last_cusp);
  const double distance = std::sqrt(centers.square);
  if (distance > (one + two) * (1.0 + kTurnRounding) || distance < std::abs(one - two)) {
    return;
  }
  // Apply the law of cosines. The centers of the outer turns coincide only if the links `one` and
  // `two` to the middle turn are equally long.
  const double unequal =
      one == two ? 0.0 : (one - two) * (one + two) / (2.0 * std::max(distance, kTurnRounding));
  const auto angle = [](double cos) { return std::acos(std::clamp(cos, -1.0, 1.0)); };
  const double at_first = angle((0.5 * distance + unequal) / one);
  const double at_last = one == two ? at_first : angle((0.5 * distance - unequal) / two);
  const double line = std::atan2(centers.line.y(), centers.line.x());
  TurnChain chain = Chain(centers, 3);
  chain.side[1] = -chain.side[0];
  chain.direction[1] = first_cusp ? -chain.direction[0] : chain.direction[0];
  for (const double sign : {1.0, -1.0}) {
    chain.junctions[0] =
        Touch(line + sign * at_first, first_cusp, chain.side[0], chain.direction[0]);
    chain.junctions[1] = Touch(line - sign * at_last, last_cusp, chain.side[1], chain.direction[1]);
    consider(chain);
  }
}

template <typename Consider>
void ChainFinder::OfFourTurns(const Centers& centers, bool outer_cusps, bool inner_cusp,
                              const Consider& consider) const {
  const double outer = Link(outer_cusps);
  const double inner = Link(inner_cusp);
  const double distance = std::sqrt(centers.square);
  if (distance > (2.0 * outer + inner) * (1.0 + kTurnRounding)) {
    return;
  }
  const double line = std::atan2(centers.line.y(), centers.line.x());
  TurnChain chain = Chain(centers, 4);
  for (const std::size_t i : {1U, 2U}) {
    chain.side[i] = -chain.side[i - 1];
    const bool cusp = i == 1 ? outer_cusps : inner_cusp;
    chain.direction[i] = cusp ? -chain.direction[i - 1] : chain.direction[i - 1];
  }
  const auto add = [&](double first, double middle, double last) {
    const std::array<double, 3> angles{first, middle, last};
    for (std::size_t i = 0; i < 3; ++i) {
      chain.junctions[i] = Touch(line + angles[i], i == 1 ? inner_cusp : outer_cusps, chain.side[i],
                                 chain.direction[i]);
    }
    consider(chain);
  };
  if (outer_cusps) {
    // The four centers of the turns form a parallelogram around the middle of the line between the
    // outer centers.
    const double cos = distance > 0.0
                           ? (0.25 * distance * distance + outer * outer - 0.25 * inner * inner) /
                                 (distance * outer)
                           : 2.0;
    if (std::abs(cos) > 1.0 + kTurnRounding) {
      return;
    }
    const double first = std::acos(std::clamp(cos, -1.0, 1.0));
    const double middle =
        std::atan2(-2.0 * outer * std::sin(first), distance - 2.0 * outer * std::cos(first));
    for (const double sign : {1.0, -1.0}) {
      add(sign * first, sign * middle, sign * first);
    }
    return;
  }
  // The four centers of the turns form a trapezoid: the line between the inner centers is parallel
  // to the line between the outer centers.
  for (const double along : {1.0, -1.0}) {
    const double cos = 0.5 * (distance - along * inner) / outer;
    if (std::abs(cos) <= 1.0 + kTurnRounding) {
      const double first = std::acos(std::clamp(cos, -1.0, 1.0));
      for (const double sign : {1.0, -1.0}) {
        add(sign * first, along > 0.0 ? 0.0 : kPi, -sign * first);
      }
    }
  }
}

}  // namespace trackbed
