#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "trackbed/path/path.h"

namespace trackbed {

/// Numbers along a path and points there: u is the chord length [m], which rises.
struct ChordPoints {
  std::vector<double> u;
  std::vector<Vec2> points;
};

/// The smoothing spline of degree 5 of fit_path.h. With `period` > 0 it leads on from the last
/// point to the first one, which is `period` [m] beyond itself.
class SmoothingSpline {
 public:
  /// At least two points, at least three of a closed path.
  SmoothingSpline(const ChordPoints& fitted, double period);

  /// Minimizes with the smoothing length l [m]. False, and the spline is as before, where the
  /// equations have no solution within the machine's precision.
  bool Fit(double smoothing_length);

  /// d^order P/du^order, order 0 to 2.
  [[nodiscard]] Vec2 At(double u, int order = 0) const;

  /// Parameters from the first to the last point, of a closed path to the first one again: the
  /// knots, between which the spline is a polynomial.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  struct Basis {
    Eigen::Index first;       // of the coefficients that count, up to the period
    Eigen::ArrayXXd factors;  // a row for each derivative
  };
  [[nodiscard]] Basis BasisAt(double u, int order) const;
  [[nodiscard]] Eigen::Index Coefficient(Eigen::Index i) const { return i % size_; }
  void AddData(const ChordPoints& fitted);
  void AddPenalty();

  double period_;
  std::vector<double> knots_;
  Eigen::Array<double, 1, Eigen::Dynamic> all_knots_;
  Eigen::Index size_ = 0;  // of the coefficients
  Matrix data_;
  Matrix penalty_;
  Eigen::MatrixX2d right_;
  Eigen::MatrixX2d coefficients_;
  Eigen::SimplicialLDLT<Matrix> solver_;
  bool is_analyzed_ = false;
};

/// The spline as points along it, followed by segments (SegmentsThrough).
struct SampledSpline {
  std::vector<CurvePoint> points;
  std::vector<double> knot_stations;  ///< [m]
};

/// At most `spacing` [m] apart and turning by at most 0.2 rad between them. Empty where the spline
/// stands still or turns on the spot.
SampledSpline Sample(const SmoothingSpline& spline, double spacing);

}  // namespace trackbed
