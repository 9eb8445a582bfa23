#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "src/identify/linear_model.h"
#include "src/identify/residuals.h"
#include "trackbed/identify/identify.h"

namespace trackbed {

/// Thrown when the caller wants no more of an identification; it does not leave Identify.
struct Interrupted {};

/// Counts evaluations and tells the caller how far the work is.
class Work {
 public:
  Work(const IdentificationHooks& hooks, int most);

  /// Throws Interrupted when the caller wants no more.
  void Count();
  /// What was not needed of a budget is done, too.
  void SkipTo(int evaluations);
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  const IdentificationHooks& hooks_;
  int most_;
  int evaluations_ = 0;
};

/// Where the search begins: the study's start values or the car's own, within the bounds.
std::vector<double> StartValues(const Identification& study, const CarModel& car);

/// The estimate on its way: all parameters, of which some are free. Keeps references.
class Estimator {
 public:
  Estimator(const Identification& study, const ResidualModel& model, Work& work);

  [[nodiscard]] const std::vector<double>& start() const { return start_; }
  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] double best_cost() const { return best_cost_; }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }

  /// Holds the parameters that leave the cost as it is, to the last bit: a plant without that part.
  /// Gives them back.
  std::vector<std::size_t> HoldInert();

  /// Gauss-Newton steps within a trust region from there on; the best of all stays. Gives back the
  /// cost that it reached. Each step is a quadratic program with the bounds, which NLopt's SLSQP
  /// solves. (SLSQP on the cost itself takes six times as many evaluations: it has to learn the
  /// Hessian that the residuals give away.)
  double Improve(std::vector<double> at);

  /// A random point within the bounds, of the free parameters.
  std::vector<double> Random(std::mt19937_64& generator) const;

  /// No longer estimates a parameter.
  void Hold(std::size_t index);

 private:
  [[nodiscard]] double Cost(const std::vector<double>& values) const;
  void Keep(const std::vector<double>& values, double cost);
  [[nodiscard]] std::vector<double> Moved(std::vector<double> values,
                                          const Eigen::VectorXd& step) const;
  /// The step to the minimum of the linear model within the bounds and the trust region, over the
  /// widths.
  [[nodiscard]] Eigen::VectorXd Step(const LinearModel& linear, const std::vector<double>& at,
                                     double radius) const;

  const Identification& study_;
  const ResidualModel& model_;
  Work& work_;
  std::vector<double> start_;
  std::vector<std::size_t> free_;
  std::vector<double> best_;
  double best_cost_ = 0.0;
};

}  // namespace trackbed
