#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// The value of a function of the station, with its derivatives.
struct CubicValue {
  double value = 0.0;
  double slope = 0.0;   ///< First derivative [1/m].
  double second = 0.0;  ///< Second derivative [1/m^2].
};

/// Consecutive cubic polynomials a + b d + c d^2 + e d^3, where d is the distance from the start of
/// the piece.
class PiecewiseCubic {
 public:
  struct Piece {
    double s = 0.0;                        ///< Station of the start [m].
    std::array<double, 4> coefficients{};  ///< Coefficients a, b, c, e.
  };

  PiecewiseCubic() = default;
  /// InternalError unless the starts of the pieces are nondecreasing.
  explicit PiecewiseCubic(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// Returns the value at s; 0 before the first piece, and without pieces. If several pieces begin
  /// at the same station, the last one applies. Cost O(log n).
  [[nodiscard]] CubicValue At(double s) const { return At(s, s); }
  /// The value at s of the piece that applies at station `piece_of`.
  [[nodiscard]] CubicValue At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

/// A curve (u(p), v(p)) of two cubic polynomials, evaluated at its arc length.
///
/// Arc lengths and their inverse are exact to 1e-9 of the curve's length.
class ParametricCubic {
 public:
  /// Makes the curve for p from 0 to `p_end`. The stations are scaled uniformly so that the curve
  /// ends at `length` [m]. InternalError unless the curve has a positive and finite arc length.
  ParametricCubic(const std::array<double, 4>& u, const std::array<double, 4>& v, double p_end,
                  double length);

  /// Makes the curve (u, v(u)) from u = 0 up to the arc length `length`. Throws the InternalErrors
  /// of the constructor.
  static ParametricCubic OverU(const std::array<double, 4>& v, double length);

  /// Arc length of the curve before scaling [m].
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
  std::vector<double> lengths_;  // Arc length up to each of the evenly spaced parameters.
};

/// A point of a reference line.
struct ReferenceLinePoint {
  Pose2 pose;
  double curvature = 0.0;  ///< Curvature [1/m].
  double sharpness = 0.0;  ///< Derivative of the curvature over arc length [1/m^2].
  /// Arc length per station; 1 unless the length in the file differs from the curve's.
  double stretch = 1.0;
};

/// The planar curve along which a road's stations are counted. Each piece begins at the position
/// stated in the file, even if the previous piece ends elsewhere.
class ReferenceLine {
 public:
  struct Piece {
    double s = 0.0;       ///< Station of the start [m].
    double length = 0.0;  ///< Length [m], > 0.
    Pose2 start;
    /// The curve: a line, an arc or a clothoid from `start`, or a curve in the frame of `start`.
    std::variant<Path, ParametricCubic> curve;
  };

  ReferenceLine() = default;
  /// InternalError unless there is a piece and the starts of the pieces increase.
  explicit ReferenceLine(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// The point at s, of the piece that applies at s. Lines and arcs are exact, other pieces to 1e-9
  /// m. Cost O(log n).
  [[nodiscard]] ReferenceLinePoint At(double s) const { return At(s, s); }
  /// The point at s, of the piece that applies at station `piece_of`.
  [[nodiscard]] ReferenceLinePoint At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

}  // namespace trackbed
