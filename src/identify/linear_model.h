#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "src/identify/residuals.h"

namespace trackbed {

/// Local quadratic model of the cost around an estimate. The variables are the free parameters,
/// divided by their ranges.
struct LinearModel {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< Hessian of the cost in the Gauss-Newton approximation
  Eigen::MatrixXd
      of_windows;  ///< contribution of each window to the gradient, one column each, without priors
};

/// Returns the cost of parameter values; NaN if the car model cannot be compiled with these values.
double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values);

/// Linearizes the residuals by central differences and returns the local model of the cost.
/// Linearize calls `count` before each evaluation. Throws InternalError if the car model cannot be
/// compiled with the estimate.
LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count = {});

/// Returns the covariance of the estimate, relative to the parameters' ranges. The diagonal is
/// infinite for parameters in the null space of the Hessian.
Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free);

}  // namespace trackbed
