#pragma once

#include <vector>

#include "src/control/error_model.h"

namespace trackbed {

/// Computes a linear-quadratic regulator with preview, whose input w has the bounds -w_max and
/// w_max.
///
/// The deviation z of a car from its path follows
///   z(k+1) = A z(k) + b w(k) + g(k),  abs(w(k)) <= w_max for k < n,
/// with the steering input w and known disturbances g(0) to g(n-1) caused by the path ahead. The
/// cost counts the difference of w(k) from the steering rate r(k) of the path. The disturbance g(k)
/// and the rate r(k) are 0 for k >= n. Without bounds on w, the cost of the Regulator (gain K, cost
/// matrix P) is minimized by
///   w*(k) = r(k) - K z*(k) - b' s(k)/(R + b'Pb),  s(k) = P (g(k) + b r(k)) + (A - b K)' s(k+1).
/// Let q = w - w* and x = z - z* be the differences from the optimum w* without bounds and its
/// states z*. Any input other than w* exceeds the minimum cost by (R + b'Pb) J, with the weight R
/// of the input and
///   J = sum over k of (q(k) + K x(k))^2,  x(k+1) = A x(k) + b q(k),  x(0) = 0.
/// If abs(w*(k)) exceeds w_max for some k, BoundedRegulator minimizes J subject to the bounds of w.
/// This strictly convex quadratic program is solved by a primal-dual interior-point method, whose
/// Newton steps are Riccati recursions (Rao et al. 1998; Mehrotra 1992). The starting point of the
/// interior-point method satisfies all bounds, and its multipliers make the Lagrangian stationary.
/// Each iteration preserves the bounds and the stationarity, because inputs and multipliers use the
/// same step length. Since all iterates are feasible, the duality gap bounds how much J exceeds its
/// minimum.
///
/// Guarantees: the input w(0) is within its bounds. The cost J is within kGap w_max^2 of its
/// minimum, unless the method needs more than kMaxIterations. With a preview of 100 steps,
/// BoundedRegulator usually needs 8 to 14 iterations.
class BoundedRegulator {
 public:
  static constexpr int kMaxIterations = 30;
  static constexpr double kGap = 1e-9;

  /// Removes all disturbances g of the path ahead.
  void Clear() {
    pushes_.clear();
    path_rates_.clear();
  }
  /// Appends the disturbance g that the path causes in the next step, and the steering rate r of
  /// the path in this step.
  void Append(const ErrorModel::Vector& push, double path_rate) {
    pushes_.push_back(push);
    path_rates_.push_back(path_rate);
  }

  /// Returns the input w(0) within [-most, most], for the deviation z(0). `most` is the bound
  /// w_max, > 0. The returned input does not depend on earlier calls. Each iteration costs O(n) for
  /// n disturbances. Input allocates heap memory only for more disturbances than in all earlier
  /// calls.
  double Input(const ErrorModel& model, const Regulator& regulator, const ErrorModel::Vector& z,
               double most);

  /// Returns the inputs w for all steps that the last call of Input computed.
  [[nodiscard]] const std::vector<double>& inputs() const { return inputs_; }
  /// Returns the number of iterations of the last call of Input; 0 if no bound was active.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, ErrorModel::kMaxStates>;
  /// One step of the quadratic program; inputs are divided by w_max.
  struct Step {
    double input = 0.0;         // w
    double upper = 0.0;         // Lagrange multiplier of w <= 1.
    double lower = 0.0;         // Lagrange multiplier of w >= -1.
    double slope = 0.0;         // Linear coefficient of the Newton step's cost.
    double turn = 0.0;          // Newton step of w.
    double upper_change = 0.0;  // Newton step of the multiplier `upper`.
    double lower_change = 0.0;
    double curvature = 0.0;  // Second derivative of the cost by the input w.
    Row feedback;            // The Newton step of w is -(feedback x + offset).
  };

  void PredictWithoutBounds(const ErrorModel& model, const Regulator& regulator,
                            const ErrorModel::Vector& z);
  void Begin(const ErrorModel& model, const Regulator& regulator, double most);
  void Factor(const ErrorModel& model, const Regulator& regulator);
  /// Computes the Newton step toward a point at which each complementarity product (slack times
  /// multiplier) is `product`. If `corrects` is set, accounts for the second-order terms of the
  /// previous Newton step.
  void ComputeStep(const ErrorModel& model, double product, bool corrects);
  /// Returns the fraction of the Newton step, at most 1, at which the first input or multiplier
  /// reaches its bound.
  [[nodiscard]] double StepToBound() const;
  /// Returns the mean complementarity product after the fraction `part` of the Newton step.
  [[nodiscard]] double MeanProduct(double part) const;

  std::vector<ErrorModel::Vector> pushes_;
  std::vector<double> path_rates_;  // r
  std::vector<Step> steps_;
  std::vector<double> inputs_;  // w
  int iterations_ = 0;
};

}  // namespace trackbed
