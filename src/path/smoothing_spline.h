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

/// The smoothing spline of degree 5 of fit_path.h. With `period` > 0 [m] it is closed: the last
/// point connects to the first one, and u repeats after `period`.
class SmoothingSpline {
 public:
  /// Needs at least two points, or three for a closed path.
  SmoothingSpline(const ChordPoints& fitted, double period);

  /// Fits with the smoothing length l [m]. Returns false and leaves the spline unchanged if the
  /// equations are singular to machine precision.
  bool Fit(double smoothing_length);

  /// d^order P/du^order, for order 0 to 2.
  [[nodiscard]] Vec2 At(double u, int order = 0) const;

  /// The knots, between which the spline is a polynomial: from the first point's u to the last
  /// point's; for a closed path, to the first point's u one period later.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  struct Basis {
    Eigen::Index first;       // index of the first nonzero coefficient, up to the period
    Eigen::ArrayXXd factors;  // one row per derivative
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
  bool is_too_long = false;           ///< more points than allowed
};

/// Samples at most `spacing` [m] apart that turn by at most 0.2 rad from one to the next. Empty if
/// the spline has a cusp, or if that takes more than `max_points` points.
SampledSpline Sample(const SmoothingSpline& spline, double spacing, std::size_t max_points);

}  // namespace trackbed
