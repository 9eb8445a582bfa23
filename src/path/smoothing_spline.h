#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Points along a path by ascending chord length u [m].
struct ChordPoints {
  std::vector<double> u;
  std::vector<Vec2> points;
};

/// The smoothing spline of degree 5 of fit_path.h. With `period` > 0 [m], the spline is closed. The
/// last point of a closed spline connects to the first point, and u repeats after `period`.
class SmoothingSpline {
 public:
  /// Needs at least two points for an open path, and at least three points for a closed path.
  SmoothingSpline(const ChordPoints& fitted, double period);

  /// Fits the spline with the smoothing length l [m]. If the equations are singular to machine
  /// precision, returns false and leaves the spline unchanged.
  bool Fit(double smoothing_length);

  /// Derivative d^order P/du^order, for order 0 to 2.
  [[nodiscard]] Vec2 At(double u, int order = 0) const;

  /// The knots, between which the spline is a polynomial. The first knot is the first point's u.
  /// The last knot is the last point's u or, for a closed path, the first point's u one period
  /// later.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  struct Basis {
    // Index of the first nonzero coefficient, before the modulus of Coefficient.
    Eigen::Index first;
    Eigen::ArrayXXd factors;  // Factors of the coefficients, one row per derivative.
  };
  [[nodiscard]] Basis BasisAt(double u, int order) const;
  [[nodiscard]] Eigen::Index Coefficient(Eigen::Index i) const { return i % size_; }
  void AddData(const ChordPoints& fitted);
  void AddPenalty();

  double period_;
  std::vector<double> knots_;
  Eigen::Array<double, 1, Eigen::Dynamic> all_knots_;
  Eigen::Index size_ = 0;  // number of coefficients
  Matrix data_;
  Matrix penalty_;
  Eigen::MatrixX2d right_;
  Eigen::MatrixX2d coefficients_;
  Eigen::SimplicialLDLT<Matrix> solver_;
  bool is_analyzed_ = false;
};

/// Points along the spline, to be joined by segments (SegmentsThrough).
struct SampledSpline {
  std::vector<CurvePoint> points;
  std::vector<double> knot_stations;  ///< [m]
  bool is_too_long = false;           ///< Whether sampling would need more points than allowed.
};

/// Samples the spline at most `spacing` [m] apart. Adjacent samples differ by at most 0.2 rad in
/// heading. Returns no points if the spline has a cusp, or if the samples would exceed
/// `max_points`.
SampledSpline Sample(const SmoothingSpline& spline, double spacing, std::size_t max_points);

}  // namespace trackbed
