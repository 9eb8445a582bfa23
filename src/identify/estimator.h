#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/identify/identify.h"

namespace trackbed {

/// Counts evaluations of the cost and reports the progress to the caller.
class ProgressCounter {
 public:
  ProgressCounter(const IdentificationHooks& hooks, int max_evaluations);

  /// Counts an evaluation. Throws Interrupted if the caller asks to stop.
  void Count();
  /// Counts the unused evaluations of a budget as done, up to `evaluations`.
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

/// Estimates parameters, of which some are free and the others are fixed. Estimator keeps
/// references to the arguments of its constructor.
class Estimator {
 public:
  Estimator(const Identification& study, const ResidualModel& model, ProgressCounter& work);

  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }

  /// Fixes the parameters without any effect on the cost, for example because the plant does not
  /// model the part of the car. FixInertParameters returns the indices of the fixed parameters.
  std::vector<std::size_t> FixInertParameters();

  /// Makes Gauss-Newton steps in a trust region, starting at the values `at`, and keeps the best
  /// values found. Improve() returns the cost that the last step reaches. Each step is a quadratic
  /// program with the bounds, solved by NLopt's SLSQP. (If SLSQP minimized the cost itself, it
  /// would need six times as many evaluations. SLSQP would have to approximate the Hessian, which
  /// the residuals already provide.)
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
  /// Returns the step to the minimum of the local model within bounds and trust region. The step is
  /// relative to the parameters' ranges.
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
