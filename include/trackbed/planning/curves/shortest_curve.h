#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// What Dubins and Reeds-Shepp curves are made of: arcs of one radius and straights.
///
/// Symbols: r radius of every arc [m]; a piece's sweep is its length over r, negative backwards: of
/// an arc the angle that it turns through [rad].
namespace trackbed {

/// Where a piece bends to.
enum class Bend : signed char { kRight = -1, kNone = 0, kLeft = 1 };

struct CurvePiece {
  Bend bend = Bend::kNone;
  double sweep = 0.0;  ///< length/r, negative backwards
};

/// Up to five pieces, one after the other: a word such as "LSR", or "L+R-L-". It leads to within
/// 1e-9 m of the pose that it was asked for, for distances up to 1e3 r.
struct ShortestCurve {
  double radius = 1.0;  ///< r [m]
  std::array<CurvePiece, 5> pieces{};
  int count = 0;        ///< of pieces
  double length = 0.0;  ///< r times the sum of |sweep| [m]; infinite when there is no such curve
};

/// L, S or R for each piece of some length, each followed by + forwards and - backwards.
std::string CurveWord(const ShortestCurve& curve);

/// Its pieces as segments of a path; those below 1e-12 r are left out.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
