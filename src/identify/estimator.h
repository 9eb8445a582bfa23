#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/identify/identify.h"

namespace trackbed {

/// Counts evaluations of the cost function and reports the progress to the caller.
class ProgressCounter {
 public:
  ProgressCounter(const IdentificationHooks& hooks, int max_evaluations);

  /// Counts an evaluation of the cost. Throws Interrupted if the caller asks to stop.
  void Count();
  /// Sets the count to `evaluations`, so that the progress includes evaluations that a search did
  /// not need.
  void SkipTo(int evaluations);
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  const IdentificationHooks& hooks_;
  int max_evaluations_;
  int evaluations_ = 0;
};

/// Returns the initial values of the search: the start values of the study, or else the values of
/// the car model, clamped to the bounds.
std::vector<double> StartValues(const Identification& study, const CarModel& car);

/// Estimates the free parameters of a car model; all fixed parameters keep their values. The
/// arguments of the constructor must outlive the Estimator.
class Estimator {
 public:
  Estimator(const Identification& study, const ResidualModel& model, ProgressCounter& work);

  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }

  /// Fixes the parameters that have no effect on the cost, such as parameters of a part of the car
  /// that the plant does not model. FixInertParameters returns the indices of the fixed parameters.
  std::vector<std::size_t> FixInertParameters();

  /// Makes Gauss-Newton steps in a trust region, starting at the values `at`, and keeps the best
  /// values found. Improve() returns the cost after the last step. Each Gauss-Newton step is the
  /// solution of a quadratic program within the parameters' bounds, which NLopt's SLSQP solves.
  /// SLSQP could also minimize the cost directly, but would need six times as many evaluations.
  /// SLSQP would have to approximate the Hessian, which the Gauss-Newton method computes from the
  /// residuals.
  double Improve(std::vector<double> at);

  /// Returns random values of the free parameters within their bounds.
  std::vector<double> Random(std::mt19937_64& generator) const;

  /// Fixes a parameter at its start value.
  void FixParameter(std::size_t index);

 private:
  [[nodiscard]] double Cost(const std::vector<double>& values) const;
  void Keep(const std::vector<double>& values, double cost);
  [[nodiscard]] std::vector<double> Moved(std::vector<double> values,
                                          const Eigen::VectorXd& step) const;
  /// Returns the step from `at` to the minimum of the local quadratic model within the parameters'
  /// bounds and the trust region. The components of the step are fractions of the parameters'
  /// ranges.
  [[nodiscard]] Eigen::VectorXd Step(const LinearModel& linear, const std::vector<double>& at,
                                     double radius) const;

  const Identification& study_;
  const ResidualModel& model_;
  ProgressCounter& counter_;
  std::vector<double> start_;
  std::vector<std::size_t> free_;
  std::vector<double> best_;
  double best_cost_ = 0.0;
};

}  // namespace trackbed
