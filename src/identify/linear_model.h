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
  Eigen::MatrixXd hessian;  ///< Hessian of the cost in the Gauss-Newton approximation
  Eigen::MatrixXd
      of_windows;  ///< contribution of each window to the gradient, one column each, without priors
};

/// Cost of the parameter values; NaN if the model cannot be compiled with them.
double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values);

/// Linearizes the cost by central differences. Linearize calls `count` before each evaluation.
/// Throws InternalError if the estimate cannot be compiled.
LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count = {});

/// Covariance of the estimate, relative to the parameters' ranges. The diagonal is infinite for
/// parameters in the null space of the Hessian.
Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free);

}  // namespace trackbed
