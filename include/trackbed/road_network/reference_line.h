#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// The value and the derivatives of a function of the station.
struct CubicValue {
  double value = 0.0;
  double slope = 0.0;   ///< First derivative of the function by the station [1/m].
  double second = 0.0;  ///< Second derivative of the function by the station [1/m^2].
};

/// A function of the station that consists of cubic polynomial pieces a + b d + c d^2 + e d^3,
/// where d is the distance from the start of the piece.
class PiecewiseCubic {
 public:
  struct Piece {
    double s = 0.0;                        ///< Station of the start of the piece [m].
    std::array<double, 4> coefficients{};  ///< Coefficients a, b, c and e of the polynomial.
  };

  PiecewiseCubic() = default;
  /// Throws InternalError if the start stations of the pieces decrease.
  explicit PiecewiseCubic(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// Returns the value of the function at station s; 0 before the first piece, and 0 if there are
  /// no pieces. If several polynomial pieces begin at the same station, the last of them applies.
  /// Computing time: O(log n) for n pieces.
  [[nodiscard]] CubicValue At(double s) const { return At(s, s); }
  /// Returns the value at station s of the polynomial piece that At(`piece_of`) uses.
  [[nodiscard]] CubicValue At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

/// A curve (u(p), v(p)) of two cubic polynomials, which is evaluated at a given arc length.
///
/// Arc lengths, and the parameters p at given arc lengths, have errors of at most 1e-9 times the
/// curve's length.
class ParametricCubic {
 public:
  /// Makes the curve (u(p), v(p)) for the parameter p from 0 to `p_end`. Stations along the curve
  /// are scaled uniformly so that the station at the end of the curve is `length` [m]. Throws
  /// InternalError unless the arc length of the curve is positive and finite.
  ParametricCubic(const std::array<double, 4>& u, const std::array<double, 4>& v, double p_end,
                  double length);

  /// Makes the curve (u, v(u)) from u = 0 to the point at which the arc length is `length`. Throws
  /// InternalError in the same cases as the constructor of ParametricCubic.
  static ParametricCubic OverU(const std::array<double, 4>& v, double length);

  /// Returns the arc length of the curve before the stations are scaled [m].
  [[nodiscard]] double arc_length() const { return lengths_.back(); }

  struct Point {
    Vec2 position{0.0, 0.0};  ///< Position [m].
    double heading = 0.0;     ///< Heading [rad].
    double curvature = 0.0;   ///< Curvature [1/m].
    double sharpness = 0.0;   ///< Derivative of the curvature over arc length [1/m^2].
  };
  [[nodiscard]] Point At(double distance) const;

 private:
  [[nodiscard]] double Speed(double p) const;
  [[nodiscard]] double Parameter(double arc) const;

  std::array<double, 4> u_;
  std::array<double, 4> v_;
  double p_end_ = 1.0;
  double length_ = 0.0;
  // Arc length from the start of the curve to each of several evenly spaced parameters p.
  std::vector<double> lengths_;
};

/// Pose and curvature of a reference line at one station.
struct ReferenceLinePoint {
  Pose2 pose;
  double curvature = 0.0;  ///< Curvature [1/m].
  double sharpness = 0.0;  ///< Derivative of the curvature over arc length [1/m^2].
  /// Ratio of arc length to station; 1 unless the length in the file differs from the arc length of
  /// the curve.
  double stretch = 1.0;
};

/// The planar curve along which a road's stations are counted. Each piece of the reference line
/// begins at the position that the file states, even if the previous piece ends elsewhere.
class ReferenceLine {
 public:
  struct Piece {
    double s = 0.0;       ///< Station of the start of the piece [m].
    double length = 0.0;  ///< Length of the piece [m], > 0.
    Pose2 start;
    /// The curve of the piece: a Path (line, arc or clothoid) from `start`, or a ParametricCubic in
    /// the coordinate frame of `start`.
    std::variant<Path, ParametricCubic> curve;
  };

  ReferenceLine() = default;
  /// Throws InternalError unless there is at least one piece and the start stations of the pieces
  /// increase.
  explicit ReferenceLine(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// Returns the point of the reference line at station s. The returned point is exact to rounding
  /// on lines and arcs, and to 1e-9 m on other pieces. Computing time: O(log n) for n pieces.
  [[nodiscard]] ReferenceLinePoint At(double s) const { return At(s, s); }
  /// Returns the point at station s on the piece of the reference line that At(`piece_of`) uses.
  [[nodiscard]] ReferenceLinePoint At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

}  // namespace trackbed
