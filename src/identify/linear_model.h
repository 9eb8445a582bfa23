#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "src/identify/residuals.h"

namespace trackbed {

/// Local model of the cost around an estimate, in the free parameters divided by their ranges.
struct LinearModel {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< Gauss-Newton approximation
  Eigen::MatrixXd
      of_windows;  ///< one column per window: its contribution to the gradient, without priors
};

/// Cost of the values; NaN if the model cannot be compiled with them.
double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values);

/// Linearizes by central differences. Calls `count` before each evaluation. InternalError if the
/// estimate cannot be compiled.
LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count = {});

/// Covariance of the estimate, relative to the ranges. The diagonal is infinite for parameters in
/// the null space of the Hessian.
Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free);

}  // namespace trackbed
