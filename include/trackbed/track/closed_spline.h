#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

/// Closed B-splines of degree 5 with evenly spaced knots: periodic curves and functions that are
/// four times continuously differentiable.
namespace trackbed {

/// The basis functions of a closed spline: one basis function for each knot in a period.
class ClosedSplineBasis {
 public:
  /// Number of basis functions that are nonzero at a point.
  static constexpr std::size_t kSupport = 6;
  /// Minimum number of basis functions in a spline.
  static constexpr std::size_t kMinFunctions = 6;

  /// The basis functions that are nonzero at a point: indices, values and derivatives.
  struct Local {
    std::array<Eigen::Index, kSupport> index{};
    /// Derivatives of order 0, 1 and 2 of the nonzero functions with respect to the parameter.
    std::array<std::array<double, kSupport>, 3> weight{};
  };

  /// Makes a basis. Throws PreconditionError unless `period` is positive and finite, and the number
  /// of basis functions `count` is at least kMinFunctions.
  ClosedSplineBasis(double period, std::size_t count);

  [[nodiscard]] double period() const { return period_; }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Evaluates the basis functions at the parameter `t`, which may be any finite number and is
  /// wrapped to one period. If `order` is set, evaluates only the derivative of that order of the
  /// basis functions.
  [[nodiscard]] Local At(double t, std::optional<std::size_t> order = {}) const;

 private:
  double period_;
  std::size_t count_;
};

/// Evaluates a spline or its derivative of `order` 0 to 2. The value of the spline is the sum over
/// j of c_j B_j^(order)(t), where B_j are the basis functions and c_j is row j of the matrix
/// `coefficients`.
Eigen::RowVectorXd Evaluate(const ClosedSplineBasis::Local& at, const Eigen::MatrixXd& coefficients,
                            std::size_t order);

/// Samples of a curve to which a spline is fitted.
struct SplineSamples {
  std::vector<double> t;  ///< Parameter of each sample, within one period.
  /// Weight of each sample: the length of curve that the sample represents, > 0.
  std::vector<double> weights;
  Eigen::MatrixXd values;  ///< Value of each sample, as one row.
};

/// Fits a spline P(t) to samples p_i with parameters t_i and weights w_i: computes the coefficients
/// that minimize
///   sum of w_i |P(t_i) - p_i|^2 + (wavelength/(2 pi))^6 integral of |P'''|^2 dt,
/// where the integral is approximated by third differences of the coefficients (P-splines, Eilers
/// and Marx 1996). A wave of length l along the curve is attenuated by the factor 1/(1 +
/// (wavelength/l)^6). FitClosedSpline attenuates a wave to 50 % at `wavelength`, to 98 % at twice
/// `wavelength`, and to 1.5 % at half of `wavelength`. Cost O(count). Throws PreconditionError
/// unless all samples have a parameter, a weight and a value, and the wavelength is positive.
Eigen::MatrixXd FitClosedSpline(const ClosedSplineBasis& basis, const SplineSamples& samples,
                                double wavelength);

}  // namespace trackbed
