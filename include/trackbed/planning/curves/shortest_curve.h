#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/path/path.h"

/// Defines the elements of shortest curves: straights, arcs of one radius, and turns that ramp the
/// curvature up and down. Dubins curves and Reeds-Shepp curves (dubins.h, reeds_shepp.h) have no
/// ramps, and curves of continuous curvature (continuous_curvature.h) have ramps at every turn.
///
/// Symbols: r is the radius of the sharpest arc [m]. Curvatures of curve pieces are in units of
/// 1/r, and lengths in units of the radius r. The sweep of a curve piece is the length of its
/// straight or arc, with a negative sign for driving backwards. Because lengths are in units of r,
/// the sweep of an arc of radius r is the arc's angle [rad].
namespace trackbed {

/// The side to which a piece of a curve bends.
enum class Bend : signed char { kRight = -1, kNone = 0, kLeft = 1 };

/// The clothoids before and after the arc of a turn. The turn's curvature changes at the rate
/// `sharpness` from `first` to `peak` before the arc, and from `peak` to `last` after the arc.
struct CurveRamps {
  double first = 0.0;      ///< Curvature at the start of the turn [1/r].
  double peak = 0.0;       ///< Curvature of the arc of the turn [1/r].
  double last = 0.0;       ///< Curvature at the end of the turn [1/r].
  double sharpness = 0.0;  ///< Change of curvature per length on the ramps [1/r^2]; 0: no ramps.
  int direction = 1;       ///< Direction of motion on the turn's ramps: +1 forwards, -1 backwards.
};

struct CurvePiece {
  Bend bend = Bend::kNone;
  double sweep = 0.0;  ///< Sweep of the straight or arc; negative for driving backwards.
  CurveRamps ramps{};  ///< Curvature ramps before and after the arc; none by default.
};

/// A curve of up to seven consecutive pieces, described by a word such as "L+S+R+" or "L+R-L-". For
/// distances up to 1e3 r, the curve ends within 1e-9 m of the requested pose.
struct ShortestCurve {
  double radius = 1.0;  ///< Radius r of the curve's arcs [m].
  std::array<CurvePiece, 7> pieces{};
  int count = 0;  ///< Number of pieces of the curve.
  /// Length of the curve, the sum over the lengths of all pieces [m]; infinite if no curve exists.
  double length = 0.0;
};

/// Returns the word that describes a curve, such as "L+S+R+". Each piece of the curve with a length
/// other than 0 adds L, S or R to the word, followed by + for forwards or - for backwards. A turn
/// whose arc is driven against the direction of its ramps adds one letter to the curve's word for
/// each ramp, and one letter for the arc.
std::string CurveWord(const ShortestCurve& curve);

/// Converts the pieces of a curve to segments of a path, and leaves out segments shorter than 1e-12
/// r.
std::vector<Segment> ToSegments(const ShortestCurve& curve);

}  // namespace trackbed
