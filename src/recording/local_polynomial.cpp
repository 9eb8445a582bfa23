#include "src/recording/local_polynomial.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns the value of the tricube weight function of Cleveland (1979) at `u`.
double Tricube(double u) {
  const double rest = 1.0 - std::abs(u * u * u);
  return rest * rest * rest;
}

}  // namespace

std::vector<LogStretch> SplitAtGaps(const std::vector<double>& time, double gap) {
  std::vector<LogStretch> stretches;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (i == 0 || time[i] - time[i - 1] > gap) {
      stretches.push_back({i, i});
    }
    stretches.back().end = i + 1;
  }
  return stretches;
}

LocalFit LocalPolynomial::At(double at, const LogStretch& stretch) const {
  TRACKBED_CHECK(stretch.end > stretch.first, "a fit without rows");
  const auto begin = time_.begin() + static_cast<std::ptrdiff_t>(stretch.first);
  const auto end = time_.begin() + static_cast<std::ptrdiff_t>(stretch.end);
  auto first = std::upper_bound(begin, end, at - half_width_);
  auto last = std::lower_bound(first, end, at + half_width_);
  const std::ptrdiff_t needed = std::min<std::ptrdiff_t>(degree_ + 1, end - begin);
  double width = half_width_;
  // Rows so close to the edge of the window that they have nearly no weight do not determine the
  // polynomial. Rows outside the fraction kEdge of the window have a weight below 1e-6 of the
  // weight in the middle.
  constexpr double kEdge = 0.9966;
  const auto inner_first = std::upper_bound(first, last, at - kEdge * half_width_);
  const auto inner_last = std::lower_bound(inner_first, last, at + kEdge * half_width_);
  if (inner_last - inner_first < needed) {
    first = inner_first;
    last = inner_last;
  }
  if (last - first < needed) {
    // Add the nearest further row, until there are enough rows to determine the polynomial.
    while (last - first < needed) {
      const bool before = first != begin && (last == end || at - *(first - 1) <= *last - at);
      before ? static_cast<void>(--first) : static_cast<void>(++last);
    }
    // Choose the width of the weight function such that the farthest row has about a third of the
    // full weight.
    width = 1.5 * std::max(at - *first, *(last - 1) - at);
    width = width > 0.0 ? width : half_width_;
  }
  const auto rows = static_cast<Eigen::Index>(last - first);
  const auto offset = static_cast<Eigen::Index>(first - time_.begin());
  const Eigen::Index terms = std::min<Eigen::Index>(degree_ + 1, rows);
  Eigen::MatrixXd powers(rows, terms);
  Eigen::MatrixXd weighted = values_.middleRows(offset, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double u = (*(first + i) - at) / width;
    const double root = std::sqrt(Tricube(u));
    double power = root;
    for (Eigen::Index k = 0; k < terms; ++k, power *= u) {
      powers(i, k) = power;
    }
    weighted.row(i) *= root;
  }
  const Eigen::MatrixXd solution = powers.householderQr().solve(weighted);
  LocalFit fit = LocalFit::Zero(3, values_.cols());
  fit.row(0) = solution.row(0);
  if (terms > 1) {
    fit.row(1) = solution.row(1) / width;
  }
  if (terms > 2) {
    fit.row(2) = 2.0 / (width * width) * solution.row(2);
  }
  return fit;
}

}  // namespace trackbed
