#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "trackbed/geometry/pose.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// A function of the station and its derivatives.
struct CubicValue {
  double value = 0.0;
  double slope = 0.0;   ///< [1/m]
  double second = 0.0;  ///< [1/m^2]
};

/// Consecutive cubic polynomials: a + b d + c d^2 + e d^3 of the distance d from the start of the
/// piece.
class PiecewiseCubic {
 public:
  struct Piece {
    double s = 0.0;                        ///< station of its start [m]
    std::array<double, 4> coefficients{};  ///< a, b, c, e
  };

  PiecewiseCubic() = default;
  /// InternalError unless the pieces' starts are nondecreasing.
  explicit PiecewiseCubic(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// 0 before the first piece, and without pieces. If several pieces begin at the same station, the
  /// last one applies. Cost O(log n).
  [[nodiscard]] CubicValue At(double s) const { return At(s, s); }
  /// The value at s of the piece that applies at `piece_of`.
  [[nodiscard]] CubicValue At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

/// A curve (u(p), v(p)) of two cubic polynomials over arc length.
///
/// Arc lengths and their inverse are exact to 1e-9 of the curve's length.
class ParametricCubic {
 public:
  /// Over p from 0 to `p_end`, with the stations scaled uniformly so that the curve ends at
  /// `length` [m]. InternalError unless the curve has a positive and finite arc length.
  ParametricCubic(const std::array<double, 4>& u, const std::array<double, 4>& v, double p_end,
                  double length);

  /// v(u) over u, up to the arc length `length`. InternalError as the constructor.
  static ParametricCubic OverU(const std::array<double, 4>& v, double length);

  /// Arc length of the curve itself, before scaling [m].
  [[nodiscard]] double arc_length() const { return lengths_.back(); }

  struct Point {
    Vec2 position{0.0, 0.0};  ///< [m]
    double heading = 0.0;     ///< [rad]
    double curvature = 0.0;   ///< [1/m]
    double sharpness = 0.0;   ///< derivative of the curvature over arc length [1/m^2]
  };
  [[nodiscard]] Point At(double distance) const;

 private:
  [[nodiscard]] double Speed(double p) const;
  [[nodiscard]] double Parameter(double arc) const;

  std::array<double, 4> u_;
  std::array<double, 4> v_;
  double p_end_ = 1.0;
  double length_ = 0.0;
  std::vector<double> lengths_;  // arc length up to each of the evenly spaced parameters
};

/// A point of a reference line.
struct ReferenceLinePoint {
  Pose2 pose;
  double curvature = 0.0;  ///< [1/m]
  double sharpness = 0.0;  ///< derivative of the curvature over arc length [1/m^2]
  /// Arc length per station; 1 unless the length in the file differs from the curve's.
  double stretch = 1.0;
};

/// The planar curve along which a road's stations are counted. Its pieces begin where the file
/// says, even if the previous piece ends elsewhere.
class ReferenceLine {
 public:
  struct Piece {
    double s = 0.0;       ///< station of its start [m]
    double length = 0.0;  ///< [m], > 0
    Pose2 start;
    /// A line, an arc or a clothoid from `start`, or a curve in the frame of `start`.
    std::variant<Path, ParametricCubic> curve;
  };

  ReferenceLine() = default;
  /// InternalError unless there is a piece and the pieces' starts increase.
  explicit ReferenceLine(std::vector<Piece> pieces);

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

  /// The point at s, of the piece that applies there. Lines and arcs are exact, other pieces to
  /// 1e-9 m. Cost O(log n).
  [[nodiscard]] ReferenceLinePoint At(double s) const { return At(s, s); }
  /// The point at s of the piece that applies at `piece_of`.
  [[nodiscard]] ReferenceLinePoint At(double s, double piece_of) const;

 private:
  std::vector<Piece> pieces_;
};

}  // namespace trackbed
