#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// Defines the elements of Dubins and Reeds-Shepp curves, which are straights and arcs of one
/// radius.
///
/// Symbols: r is the radius of every arc [m]. The sweep of a piece is the length of the piece
/// divided by r, with a negative sign for driving backwards; the sweep of an arc is thus the arc's
/// angle [rad].
namespace trackbed {

/// The side to which a piece of a curve bends.
enum class Bend : signed char { kRight = -1, kNone = 0, kLeft = 1 };

struct CurvePiece {
  Bend bend = Bend::kNone;
  double sweep = 0.0;  ///< Sweep of the piece, equal to length/r; negative for driving backwards.
};

/// A curve of up to five consecutive pieces, described by a word such as "L+S+R+" or "L+R-L-". For
/// distances up to 1e3 r, the curve ends within 1e-9 m of the requested pose.
struct ShortestCurve {
  double radius = 1.0;  ///< Radius r of the curve's arcs [m].
  std::array<CurvePiece, 5> pieces{};
  int count = 0;  ///< Number of pieces of the curve.
  /// Length of the curve, equal to r sum(|sweep|) over all pieces [m]; infinite if no curve exists.
  double length = 0.0;
};

/// Returns the word that describes a curve. Each piece with a length other than 0 adds L, S or R to
/// the word, followed by + for forwards or - for backwards.
std::string CurveWord(const ShortestCurve& curve);

/// Converts the pieces of a curve to segments of a path, and leaves out pieces shorter than 1e-12
/// r.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
