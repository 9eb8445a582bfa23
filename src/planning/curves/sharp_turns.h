#pragma once

#include "src/planning/curves/clothoid_turns.h"

/// Words turn-straight-turn of the sharpest turns: every clothoid has the largest sharpness, and
/// the arc has the smallest curvature that suffices.
///
/// Symbols, in units of the smallest radius r: alpha is the heading of the straight, as seen from
/// the start. A turn from curvature 0 to curvature 0 changes the heading by the deflection a. The
/// ends of such a turn are the distance d(a) apart, in the direction of its mean heading. A turn
/// that begins with another curvature is the last part of a turn that begins with curvature 0. A
/// valid curve is a root of f(alpha), the distance between the two turns perpendicular to the
/// straight. The turns depend continuously on the heading alpha, and their lengths tend to 0 with
/// the deflection a. Nearly straight curves need no threshold or special case.
namespace trackbed {

/// Returns the shortest forward curve turn-straight-turn of the largest sharpness, from the origin
/// with the curvature `start` to `goal`. If no such curve is shorter than `limit`, returns a curve
/// of infinite length. The heading change of each turn differs by at most pi from the heading
/// change of a turn that only straightens the wheels. The goal is in units of the smallest radius.
/// Of two curves whose straights differ in heading by less than 0.3 rad, the search may miss both.
ShortestCurve SharpWord(const TurnCircle& circle, double start, const CurveState& goal,
                        double limit);

/// Same as ShortestSharpTurns above, but with one circle for the first turn and another for the
/// last turn.
ShortestCurve SharpWord(const TurnCircle& at_start, const TurnCircle& at_goal, double start,
                        const CurveState& goal, double limit);

/// Returns the shortest forward curve of two turns and a straight between two states [m]. Both
/// turns have the radius `radius` [m], and each has a given sharpness [1/m^2]. If no such curve is
/// shorter than `limit` [m], returns a curve of infinite length.
ShortestCurve TwoTurns(double radius, double first_sharpness, double last_sharpness,
                       const CurveState& from, const CurveState& to, double limit = kNoCurve);

}  // namespace trackbed
