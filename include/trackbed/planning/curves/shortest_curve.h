#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// The elements of Dubins and Reeds-Shepp curves: arcs of one radius and straights.
///
/// Symbols: r radius of every arc [m]; the sweep of a piece is its length over r, negative
/// backwards; for an arc it is the angle turned [rad].
namespace trackbed {

/// The direction in which a piece bends.
enum class Bend : signed char { kRight = -1, kNone = 0, kLeft = 1 };

struct CurvePiece {
  Bend bend = Bend::kNone;
  double sweep = 0.0;  ///< length/r, negative backwards
};

/// Up to five consecutive pieces: a word such as "LSR", or "L+R-L-". The curve ends within 1e-9 m
/// of the requested pose, for distances up to 1e3 r.
struct ShortestCurve {
  double radius = 1.0;  ///< r [m]
  std::array<CurvePiece, 5> pieces{};
  int count = 0;        ///< of pieces
  double length = 0.0;  ///< r times the sum of |sweep| [m]; infinite if there is no such curve
};

/// L, S or R for each piece of some length, each followed by + forwards and - backwards.
std::string CurveWord(const ShortestCurve& curve);

/// The pieces as segments of a path, without those below 1e-12 r.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
