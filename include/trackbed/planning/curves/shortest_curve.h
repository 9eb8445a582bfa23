#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// The elements of Dubins and Reeds-Shepp curves: arcs of one radius and straights.
///
/// Symbols: r radius of every arc [m]. The sweep of a piece is its length divided by r, negative
/// backwards; the sweep of an arc is its angle [rad].
namespace trackbed {

/// The direction in which a piece bends.
enum class Bend : signed char { kRight = -1, kNone = 0, kLeft = 1 };

struct CurvePiece {
  Bend bend = Bend::kNone;
  double sweep = 0.0;  ///< Sweep: length/r, negative backwards.
};

/// A curve of up to five consecutive pieces: a word such as "LSR", or "L+R-L-". The curve ends
/// within 1e-9 m of the requested pose, for distances up to 1e3 r.
struct ShortestCurve {
  double radius = 1.0;  ///< Radius r [m].
  std::array<CurvePiece, 5> pieces{};
  int count = 0;        ///< Number of pieces.
  double length = 0.0;  ///< r times the sum of |sweep| [m]; infinite if there is no such curve.
};

/// The word of a curve: L, S or R for each piece whose length is not 0, followed by + forwards or -
/// backwards.
std::string CurveWord(const ShortestCurve& curve);

/// The pieces as segments of a path, without pieces shorter than 1e-12 r.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
