#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

/// Closed B-splines of degree 5 with evenly spaced knots: four times continuously differentiable
/// curves and functions that repeat.
namespace trackbed {

/// The basis: as many functions as knots, spread over one period.
class ClosedSplineBasis {
 public:
  static constexpr std::size_t kSupport = 6;  ///< functions that are not 0 at a point
  static constexpr std::size_t kLeast = 6;    ///< functions

  /// The functions that are not 0 at a point, and their values.
  struct Local {
    std::array<Eigen::Index, kSupport> index{};
    /// Of the derivatives of order 0, 1 and 2 by the parameter.
    std::array<std::array<double, kSupport>, 3> weight{};
  };

  /// PreconditionError unless the period is positive and finite and there are at least kLeast
  /// functions.
  ClosedSplineBasis(double period, std::size_t count);

  [[nodiscard]] double period() const { return period_; }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// At any finite parameter: it is wrapped.
  [[nodiscard]] Local At(double t) const;

 private:
  double period_;
  std::size_t count_;
};

/// sum of c_j B_j^(order)(t), order 0 to 2; the coefficients are rows.
Eigen::RowVectorXd Evaluate(const ClosedSplineBasis::Local& at, const Eigen::MatrixXd& coefficients,
                            std::size_t order);

/// Points over the parameter, to which a spline is fitted.
struct SplineSamples {
  std::vector<double> t;        ///< parameters, within one period
  std::vector<double> weights;  ///< of each point: the length that it stands for, > 0
  Eigen::MatrixXd values;       ///< a row for each point
};

/// The coefficients that minimize
///   sum of w_i |P(t_i) - p_i|^2 + (wavelength/(2 pi))^6 integral of |P'''|^2 dt,
/// the penalty taken of the third differences of the coefficients (P-splines, Eilers and Marx
/// 1996). Of a wave of length l along the curve, 1/(1 + (wavelength/l)^6) is left: half at
/// `wavelength`, 98 % at twice, 1.5 % at half of it. Cost O(count). PreconditionError unless sizes
/// agree and the wavelength is positive.
Eigen::MatrixXd FitClosedSpline(const ClosedSplineBasis& basis, const SplineSamples& samples,
                                double wavelength);

}  // namespace trackbed
