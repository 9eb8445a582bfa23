#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/identify/residuals.h"

namespace trackbed {

/// What the residuals at an estimate say about its parameters (those that are free).
struct Uncertainty {
  Eigen::MatrixXd hessian;     ///< Gauss-Newton, of the cost
  Eigen::MatrixXd covariance;  ///< of the estimate; infinite on the diagonal where it has none
};

/// `free` are the indices of the parameters that were estimated. The Jacobian is that of central
/// differences with steps of `step` times the width of the bounds.
Uncertainty EstimateUncertainty(const Identification& study, const ResidualModel& model,
                                const std::vector<double>& estimate,
                                const std::vector<std::size_t>& free);

}  // namespace trackbed
