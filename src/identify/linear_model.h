#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "src/identify/residuals.h"

namespace trackbed {

/// Local quadratic model of the cost around an estimate. The variables of the model are the free
/// parameters, each divided by its range.
struct LinearModel {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< Hessian of the cost in the Gauss-Newton approximation
  Eigen::MatrixXd
      /// Contributions of the prediction windows to the cost's gradient, one column per window,
      /// without priors.
      of_windows;
};

/// Returns the cost of the fit for given parameter values; NaN if the car model cannot be compiled
/// with these values.
double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values);

/// Linearizes the residuals around `estimate` by central differences, and returns the local
/// quadratic model of the cost. Linearize calls the function `count` before each evaluation of the
/// residuals. Throws InternalError if the car model cannot be compiled with the estimate.
LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count = {});

/// Returns the covariance matrix of the estimated parameters, each divided by its range. The
/// variance of a parameter is infinite if the cost does not determine the parameter (null space of
/// the Hessian).
Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free);

}  // namespace trackbed
