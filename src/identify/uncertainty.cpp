#include "src/identify/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Of residual vectors: d residual/d(parameter over the width of its bounds).
std::vector<SignalResiduals> Derivative(const Identification& study, const ResidualModel& model,
                                        const std::vector<double>& estimate, std::size_t index) {
  // Steps are so large that play, whose edges make residuals kinked, averages out, and so small
  // that a Magic Formula is straight.
  constexpr double kStep = 1e-3;  // of the width
  const IdentifiedParameter& parameter = study.parameters[index];
  const double width = parameter.to - parameter.from;
  std::vector<double> at = estimate;
  at[index] = std::min(estimate[index] + kStep * width, parameter.to);
  const double high = at[index];
  std::vector<SignalResiduals> ahead = model.At(at);
  at[index] = std::max(estimate[index] - kStep * width, parameter.from);
  const double step = (high - at[index]) / width;
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

}  // namespace

Uncertainty EstimateUncertainty(const Identification& study, const ResidualModel& model,
                                const std::vector<double>& estimate,
                                const std::vector<std::size_t>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  const std::vector<SignalResiduals> residuals = model.At(estimate);
  TRACKBED_CHECK(!residuals.empty(), "an estimate that does not compile");
  std::vector<std::vector<SignalResiduals>> jacobian;
  for (const std::size_t index : free) {
    jacobian.push_back(Derivative(study, model, estimate, index));
    if (jacobian.back().size() != residuals.size()) {  // it does not compile beside the estimate
      jacobian.back() = residuals;
      for (SignalResiduals& signal : jacobian.back()) {
        std::fill(signal.values.begin(), signal.values.end(), 0.0);
      }
    }
  }
  // In units of the bounds' widths, so that the matrices are well scaled.
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(model.windows()));
  for (std::size_t s = 0; s < residuals.size(); ++s) {
    const std::vector<double>& values = residuals[s].values;
    const double share = 1.0 / static_cast<double>(values.size());
    for (std::size_t j = 0; j < values.size(); ++j) {
      Eigen::VectorXd row(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        row[i] = jacobian[static_cast<std::size_t>(i)][s].values[j];
      }
      const double weight = share * LossWeight(study, values[j]);
      hessian += weight * row * row.transpose();
      gradients.col(static_cast<Eigen::Index>(residuals[s].window)) += weight * values[j] * row;
    }
  }
  Eigen::VectorXd width(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const IdentifiedParameter& parameter = study.parameters[free[static_cast<std::size_t>(i)]];
    width[i] = parameter.to - parameter.from;
    if (parameter.prior) {
      const double precision = width[i] / parameter.prior->deviation;
      hessian(i, i) += precision * precision;
    }
  }
  const auto windows = static_cast<double>(model.windows());
  const double count = std::max(1.0, windows - static_cast<double>(n));
  Eigen::MatrixXd scatter = gradients * gradients.transpose() * (windows / count);
  // A prior is a measurement whose scatter is its own deviation.
  for (Eigen::Index i = 0; i < n; ++i) {
    const IdentifiedParameter& parameter = study.parameters[free[static_cast<std::size_t>(i)]];
    if (parameter.prior) {
      const double precision = width[i] / parameter.prior->deviation;
      scatter(i, i) += precision * precision;
    }
  }
  // Directions in which the cost is flat have no inverse: their variance is without bounds.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian);
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
  constexpr double kTakesPart = 1e-3;  // in a flat direction
  for (Eigen::Index i = 0; i < n; ++i) {
    if (flat[i] > kTakesPart) {
      covariance(i, i) = std::numeric_limits<double>::infinity();
    }
  }
  return {
      .hessian = width.cwiseInverse().asDiagonal() * hessian * width.cwiseInverse().asDiagonal(),
      .covariance = width.asDiagonal() * covariance * width.asDiagonal()};
}

}  // namespace trackbed
