#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "src/identify/residuals.h"

namespace trackbed {

/// The cost about an estimate, in the parameters that are free, each over the width of its bounds.
struct LinearModel {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< Gauss-Newton: that of linear residuals
  Eigen::MatrixXd
      of_windows;  ///< a column for each window: its share of the gradient, without priors
};

/// The cost of values; NaN of those with which the model cannot be compiled.
double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values);

/// By central differences. `count` is called before each evaluation. InternalError for an estimate
/// that cannot be compiled.
LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count = {});

/// The covariance of the estimate there, likewise over the widths; infinite on the diagonal for
/// parameters that a change of no cost contains.
Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free);

}  // namespace trackbed
