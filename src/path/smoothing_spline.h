#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Points along a path, ordered by chord length u [m].
struct ChordPoints {
  std::vector<double> u;
  std::vector<Vec2> points;
};

/// Prescribed headings at the ends of an open curve, in the direction of travel [rad]; nullopt if
/// the points determine the heading of an end.
struct EndHeadings {
  std::optional<double> begin{};
  std::optional<double> end{};
};

/// Smoothing spline of degree 5, which FitPath uses. With `period` > 0 [m], the spline is closed:
/// its last point connects to its first point, and the chord length u repeats after `period`.
class SmoothingSpline {
 public:
  /// An open path needs at least two points, and a closed path needs at least three points. The
  /// spline of an open path has the prescribed headings at its ends, almost exactly.
  SmoothingSpline(const ChordPoints& fitted, double period, const EndHeadings& headings = {});

  /// Fits the spline with the smoothing length l [m]. If the system of equations is singular to
  /// machine precision, Fit() returns false and leaves the spline unchanged.
  bool Fit(double smoothing_length);

  /// Returns the derivative d^order P/du^order of the curve P at the chord length u, for order 0 to
  /// 2.
  [[nodiscard]] Vec2 At(double u, int order = 0) const;

  /// Returns the knots, between which the spline is a polynomial. The first knot is the chord
  /// length u of the first point. The last knot is the chord length u of the last point for an open
  /// path, and that of the first point plus `period` for a closed path.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }

  /// Returns the weight of each point: the length of the path that the point represents [m]. The
  /// ends of an open path have a much larger weight, so the spline passes through these ends.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  struct Basis {
    // Index of the first spline coefficient whose basis function is not zero at u. For a closed
    // path, Coefficient() reduces the index modulo the number of coefficients.
    Eigen::Index first;
    Eigen::ArrayXXd factors;  // Values of the nonzero basis functions; row k: their derivative k.
  };
  [[nodiscard]] Basis BasisAt(double u, int order) const;
  [[nodiscard]] Eigen::Index Coefficient(Eigen::Index i) const { return i % size_; }
  void AddData(const ChordPoints& fitted, const EndHeadings& headings);
  void AddPenalty();

  std::vector<double> knots_;
  std::vector<double> weights_;
  Eigen::Array<double, 1, Eigen::Dynamic> all_knots_;
  Eigen::Index size_ = 0;  // number of coefficients
  Matrix data_;
  Matrix penalty_;
  Eigen::MatrixX2d right_;
  Eigen::MatrixX2d coefficients_;
  Eigen::SimplicialLDLT<Matrix> solver_;
  bool is_analyzed_ = false;
};

/// Points along the spline, which SegmentsThrough joins to a path.
struct SampledSpline {
  std::vector<CurvePoint> points;
  std::vector<double> knot_stations;  ///< Stations of the knots [m].
  bool is_too_long = false;           ///< Whether sampling would need more points than allowed.
};

/// Samples the spline at most `spacing` [m] apart. Adjacent samples of the spline differ by at most
/// 0.2 rad in heading. Sample returns no points if the spline has a cusp, or if it would need more
/// than `max_points` samples.
SampledSpline Sample(const SmoothingSpline& spline, double spacing, std::size_t max_points);

}  // namespace trackbed
