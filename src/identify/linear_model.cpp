#include "src/identify/linear_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns the derivative of the residuals with respect to a parameter that is scaled by its range.
std::vector<SignalResiduals> Derivative(const Identification& study, const ResidualModel& model,
                                        const std::vector<double>& estimate, std::size_t index,
                                        const std::function<void()>& count) {
  // Step of the finite difference. The step is large enough to average over the kinks that backlash
  // causes in the residuals, and small enough that the Magic Formula is almost linear within the
  // step.
  constexpr double kStep = 1e-3;  // Step as a fraction of the parameter's range.
  const IdentifiedParameter& parameter = study.parameters[index];
  const double width = parameter.to - parameter.from;
  std::vector<double> at = estimate;
  at[index] = std::min(estimate[index] + kStep * width, parameter.to);
  const double high = at[index];
  count();
  std::vector<SignalResiduals> ahead = model.At(at);
  at[index] = std::max(estimate[index] - kStep * width, parameter.from);
  const double step = (high - at[index]) / width;
  count();
  const std::vector<SignalResiduals> behind = model.At(at);
  if (ahead.size() != behind.size()) {
    return {};
  }
  for (std::size_t s = 0; s < ahead.size(); ++s) {
    for (std::size_t j = 0; j < ahead[s].values.size(); ++j) {
      ahead[s].values[j] = (ahead[s].values[j] - behind[s].values[j]) / step;
    }
  }
  return ahead;
}

double Cost(const Identification& study, const std::vector<SignalResiduals>& residuals,
            const std::vector<double>& values) {
  double cost = 0.0;
  for (const SignalResiduals& signal : residuals) {
    double sum = 0.0;
    for (const double residual : signal.values) {
      sum += Loss(study, residual);
    }
    cost += sum / static_cast<double>(signal.values.size());
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (const auto& prior = study.parameters[i].prior) {
      const double off = (values[i] - prior->mean) / prior->deviation;
      cost += 0.5 * off * off;
    }
  }
  return cost;
}

double Width(const IdentifiedParameter& parameter) {
  return parameter.to - parameter.from;
}

}  // namespace

double CostOf(const Identification& study, const ResidualModel& model,
              const std::vector<double>& values) {
  const std::vector<SignalResiduals> residuals = model.At(values);
  return residuals.empty() ? std::numeric_limits<double>::quiet_NaN()
                           : Cost(study, residuals, values);
}

LinearModel Linearize(const Identification& study, const ResidualModel& model,
                      const std::vector<double>& estimate, const std::vector<std::size_t>& free,
                      const std::function<void()>& count) {
  const auto counted = [&] {
    if (count) {
      count();
    }
  };
  const auto n = static_cast<Eigen::Index>(free.size());
  counted();
  const std::vector<SignalResiduals> residuals = model.At(estimate);
  TRACKBED_CHECK(!residuals.empty(), "an estimate that does not compile");
  std::vector<std::vector<SignalResiduals>> jacobian;
  for (const std::size_t index : free) {
    jacobian.push_back(Derivative(study, model, estimate, index, counted));
    // Replace a derivative by zeros if it lacks residuals, because the car model could not be
    // compiled with parameter values next to the estimate.
    if (jacobian.back().size() != residuals.size()) {
      jacobian.back() = residuals;
      for (SignalResiduals& signal : jacobian.back()) {
        std::fill(signal.values.begin(), signal.values.end(), 0.0);
      }
    }
  }
  LinearModel linear{
      .cost = Cost(study, residuals, estimate),
      .gradient = Eigen::VectorXd::Zero(n),
      .hessian = Eigen::MatrixXd::Zero(n, n),
      .of_windows = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(model.windows()))};
  Eigen::VectorXd row(n);
  for (std::size_t s = 0; s < residuals.size(); ++s) {
    const std::vector<double>& values = residuals[s].values;
    const double share = 1.0 / static_cast<double>(values.size());
    for (std::size_t j = 0; j < values.size(); ++j) {
      for (Eigen::Index i = 0; i < n; ++i) {
        row[i] = jacobian[static_cast<std::size_t>(i)][s].values[j];
      }
      const double weight = share * LossWeight(study, values[j]);
      linear.hessian += weight * row * row.transpose();
      linear.of_windows.col(static_cast<Eigen::Index>(residuals[s].window)) +=
          weight * values[j] * row;
    }
  }
  linear.gradient = linear.of_windows.rowwise().sum();
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t index = free[static_cast<std::size_t>(i)];
    const IdentifiedParameter& parameter = study.parameters[index];
    if (parameter.prior) {
      const double precision = Width(parameter) / parameter.prior->deviation;
      linear.hessian(i, i) += precision * precision;
      linear.gradient[i] +=
          precision * (estimate[index] - parameter.prior->mean) / parameter.prior->deviation;
    }
  }
  return linear;
}

Eigen::MatrixXd Covariance(const Identification& study, const LinearModel& linear,
                           const std::vector<std::size_t>& free) {
  const Eigen::Index n = linear.gradient.size();
  const auto windows = static_cast<double>(linear.of_windows.cols());
  const double freedom = std::max(1.0, windows - static_cast<double>(n));
  Eigen::MatrixXd scatter = linear.of_windows * linear.of_windows.transpose() * (windows / freedom);
  // A prior acts as an additional measurement of the parameter, with the prior's standard
  // deviation.
  for (Eigen::Index i = 0; i < n; ++i) {
    const IdentifiedParameter& parameter = study.parameters[free[static_cast<std::size_t>(i)]];
    if (parameter.prior) {
      const double precision = Width(parameter) / parameter.prior->deviation;
      scatter(i, i) += precision * precision;
    }
  }
  // In parameter directions in which the cost is constant (flat directions), the variance of the
  // estimate is infinite.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(linear.hessian);
  constexpr double kFlat = 1e-10;
  const double largest = std::max(eigen.eigenvalues()[n - 1], 1e-300);
  Eigen::VectorXd inverse(n);
  Eigen::VectorXd flat = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const bool is_flat = eigen.eigenvalues()[k] <= kFlat * largest;
    inverse[k] = is_flat ? 0.0 : 1.0 / eigen.eigenvalues()[k];
    if (is_flat) {
      flat = flat.cwiseMax(eigen.eigenvectors().col(k).cwiseAbs());
    }
  }
  const Eigen::MatrixXd inverted =
      eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  Eigen::MatrixXd covariance = inverted * scatter * inverted;
  // Smallest component of a flat direction (a direction without effect on the cost) with which the
  // parameter of this component counts as undetermined.
  constexpr double kFlatComponent = 1e-3;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (flat[i] > kFlatComponent) {
      covariance(i, i) = std::numeric_limits<double>::infinity();
    }
  }
  return covariance;
}

}  // namespace trackbed
