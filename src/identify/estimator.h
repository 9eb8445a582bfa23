#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/identify/identify.h"

namespace trackbed {

/// Counts evaluations and reports the progress to the caller.
class ProgressCounter {
 public:
  ProgressCounter(const IdentificationHooks& hooks, int max_evaluations);

  /// Throws Interrupted if the caller asks to stop.
  void Count();
  /// Counts unused evaluations of a budget as done.
  void SkipTo(int evaluations);
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  const IdentificationHooks& hooks_;
  int max_evaluations_;
  int evaluations_ = 0;
};

/// Initial values of the search: the study's start values or those of the model, clamped to the
/// bounds.
std::vector<double> StartValues(const Identification& study, const CarModel& car);

/// Current estimate of all parameters, some of which are free and the others fixed. Estimator keeps
/// references to its arguments.
class Estimator {
 public:
  Estimator(const Identification& study, const ResidualModel& model, ProgressCounter& work);

  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }

  /// Fixes the parameters that do not change any bit of the cost, because the plant lacks the part.
  /// FixInertParameters returns the indices of the fixed parameters.
  std::vector<std::size_t> FixInertParameters();

  /// Makes Gauss-Newton steps in a trust region, starting at `at`, and keeps the best values found.
  /// Improve() returns the cost that it reaches. Each step is a quadratic program with the bounds,
  /// solved by NLopt's SLSQP. (SLSQP on the cost itself would take six times as many evaluations.
  /// SLSQP would have to build up the Hessian, which the residuals already provide.)
  double Improve(std::vector<double> at);

  /// Random values of the free parameters within their bounds.
  std::vector<double> Random(std::mt19937_64& generator) const;

  /// Fixes a parameter at its start value.
  void FixParameter(std::size_t index);

 private:
  [[nodiscard]] double Cost(const std::vector<double>& values) const;
  void Keep(const std::vector<double>& values, double cost);
  [[nodiscard]] std::vector<double> Moved(std::vector<double> values,
                                          const Eigen::VectorXd& step) const;
  /// Step to the minimum of the linear model within bounds and trust region, relative to the
  /// parameters' ranges.
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
