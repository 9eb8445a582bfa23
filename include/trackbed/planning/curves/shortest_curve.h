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
  double sweep = 0.0;  ///< Sweep length/r; negative for driving backwards.
};

/// A curve of up to five consecutive pieces, described by a word such as "L+S+R+" or "L+R-L-". The
/// curve ends within 1e-9 m of the requested pose, for distances up to 1e3 r.
struct ShortestCurve {
  double radius = 1.0;  ///< Radius r [m].
  std::array<CurvePiece, 5> pieces{};
  int count = 0;  ///< Number of pieces.
  /// Length r sum(|sweep|) of all pieces [m]; infinite if there is no such curve.
  double length = 0.0;
};

/// Returns the word of a curve. Each piece of a length other than 0 adds L, S or R, followed by +
/// for forwards or - for backwards.
std::string CurveWord(const ShortestCurve& curve);

/// Converts the pieces to segments of a path, without pieces shorter than 1e-12 r.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
