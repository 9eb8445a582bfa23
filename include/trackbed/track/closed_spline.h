#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// Closed B-splines of degree 5 with evenly spaced knots: periodic curves and functions that are
/// four times continuously differentiable.
namespace trackbed {

/// The basis functions of a closed spline: one for each knot, over one period.
class ClosedSplineBasis {
 public:
  static constexpr std::size_t kSupport = 6;  ///< Number of functions that are nonzero at a point.
  static constexpr std::size_t kMinFunctions = 6;  ///< Minimum number of functions.

  /// The functions that are nonzero at a point, and their values.
  struct Local {
    std::array<Eigen::Index, kSupport> index{};
    /// Derivatives of order 0, 1 and 2 with respect to the parameter.
    std::array<std::array<double, kSupport>, 3> weight{};
  };

  /// Makes a basis. PreconditionError unless the period is positive and finite, and `count` is at
  /// least kMinFunctions.
  ClosedSplineBasis(double period, std::size_t count);

  [[nodiscard]] double period() const { return period_; }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Evaluates the basis at any finite parameter, which is wrapped. With `order`, evaluates only
  /// the derivative of that order.
  [[nodiscard]] Local At(double t, std::optional<std::size_t> order = {}) const;

 private:
  double period_;
  std::size_t count_;
};

/// Evaluates the sum of c_j B_j^(order)(t), order 0 to 2. Row j of the matrix `coefficients` is
/// c_j.
Eigen::RowVectorXd Evaluate(const ClosedSplineBasis::Local& at, const Eigen::MatrixXd& coefficients,
                            std::size_t order);

/// Samples of a curve, to which a spline is fitted.
struct SplineSamples {
  std::vector<double> t;        ///< Parameters, within one period.
  std::vector<double> weights;  ///< Length that each point represents, > 0.
  Eigen::MatrixXd values;       ///< One row for each point.
};

/// Fits a spline to samples: computes the coefficients that minimize
///   sum of w_i |P(t_i) - p_i|^2 + (wavelength/(2 pi))^6 integral of |P'''|^2 dt,
/// with the penalty evaluated by third differences of the coefficients (P-splines, Eilers and Marx
/// 1996). A wave of length l along the curve is attenuated to 1/(1 + (wavelength/l)^6). The
/// attenuation factor is 50 % at `wavelength`, 98 % at twice `wavelength`, and 1.5 % at half of
/// `wavelength`. Cost O(count). PreconditionError unless the sizes agree and the wavelength is
/// positive.
Eigen::MatrixXd FitClosedSpline(const ClosedSplineBasis& basis, const SplineSamples& samples,
                                double wavelength);

}  // namespace trackbed
