#include "trackbed/track/closed_spline.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <boost/math/special_functions/cardinal_b_spline.hpp>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entry = Eigen::Triplet<double>;

/// Returns the matrix that maps the coefficients of a closed spline to their cyclic third
/// differences, in which the first coefficient follows the last.
Sparse ThirdDifferences(Eigen::Index count) {
  constexpr std::array<double, 4> kStencil{-1.0, 3.0, -3.0, 1.0};
  std::vector<Entry> entries;
  for (Eigen::Index row = 0; row < count; ++row) {
    for (Eigen::Index k = 0; k < 4; ++k) {
      entries.emplace_back(row, (row + k) % count, kStencil[static_cast<std::size_t>(k)]);
    }
  }
  Sparse differences(count, count);
  differences.setFromTriplets(entries.begin(), entries.end());
  return differences;
}

}  // namespace

ClosedSplineBasis::ClosedSplineBasis(double period, std::size_t count)
    : period_(period), count_(count) {
  TRACKBED_REQUIRE(std::isfinite(period) && period > 0.0 && count >= kMinFunctions,
                   "ClosedSplineBasis: a period of {} with {} functions; must be above 0 with at "
                   "least {}",
                   period, count, kMinFunctions);
}

ClosedSplineBasis::Local ClosedSplineBasis::At(double t, std::optional<std::size_t> order) const {
  namespace bm = boost::math;
  const auto wants = [&](std::size_t own) { return !order || *order == own; };
  const double step = period_ / static_cast<double>(count_);
  const double wrapped = t - period_ * std::floor(t / period_);
  const double knot = std::floor(wrapped / step);
  const double fraction = wrapped / step - knot;
  const auto count = static_cast<Eigen::Index>(count_);
  Local local;
  for (std::size_t k = 0; k < kSupport; ++k) {
    const auto offset = static_cast<Eigen::Index>(k) - 2;
    local.index[k] = (static_cast<Eigen::Index>(knot) + offset + count) % count;
    const double x = fraction - static_cast<double>(offset);
    if (wants(0)) {
      local.weight[0][k] = bm::cardinal_b_spline<5>(x);
    }
    if (wants(1)) {
      local.weight[1][k] = bm::cardinal_b_spline_prime<5>(x) / step;
    }
    if (wants(2)) {
      local.weight[2][k] = bm::cardinal_b_spline_double_prime<5>(x) / (step * step);
    }
  }
  return local;
}

Eigen::RowVectorXd Evaluate(const ClosedSplineBasis::Local& at, const Eigen::MatrixXd& coefficients,
                            std::size_t order) {
  Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(coefficients.cols());
  for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
    value += at.weight[order][k] * coefficients.row(at.index[k]);
  }
  return value;
}

Eigen::MatrixXd FitClosedSpline(const ClosedSplineBasis& basis, const SplineSamples& samples,
                                double wavelength) {
  const std::size_t points = samples.t.size();
  TRACKBED_REQUIRE(samples.weights.size() == points &&
                       samples.values.rows() == static_cast<Eigen::Index>(points) && points > 0,
                   "FitClosedSpline: {} parameters, {} weights and {} values; must agree", points,
                   samples.weights.size(), samples.values.rows());
  TRACKBED_REQUIRE(std::isfinite(wavelength) && wavelength > 0.0,
                   "FitClosedSpline: a wavelength of {}; must be above 0", wavelength);
  const auto count = static_cast<Eigen::Index>(basis.count());
  std::vector<Entry> entries;
  Eigen::VectorXd weights(static_cast<Eigen::Index>(points));
  for (std::size_t i = 0; i < points; ++i) {
    const ClosedSplineBasis::Local local = basis.At(samples.t[i]);
    for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
      entries.emplace_back(static_cast<Eigen::Index>(i), local.index[k], local.weight[0][k]);
    }
    weights[static_cast<Eigen::Index>(i)] = samples.weights[i];
  }
  Sparse at(static_cast<Eigen::Index>(points), count);
  at.setFromTriplets(entries.begin(), entries.end());
  const Sparse differences = ThirdDifferences(count);
  const double step = basis.period() / static_cast<double>(count);
  const double penalty = std::pow(wavelength / (2.0 * kPi * step), 6.0) * step;
  const Sparse weighted = weights.asDiagonal() * at;
  const Sparse normal =
      Sparse(at.transpose() * weighted) + penalty * Sparse(differences.transpose() * differences);
  const Eigen::SimplicialLDLT<Sparse> factors(normal);
  TRACKBED_CHECK(factors.info() == Eigen::Success, "a fit of {} functions to {} points", count,
                 points);
  return factors.solve(weighted.transpose() * samples.values);
}

}  // namespace trackbed
