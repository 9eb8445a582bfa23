#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace trackbed {

/// Rows from `first` to before `end` that are never further apart than the gap of the map.
struct LogStretch {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<LogStretch> SplitAtGaps(const std::vector<double>& time, double gap);

/// Value, slope and curvature of the polynomials at one time: a row each, a column per quantity.
using LocalFit = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Local weighted polynomial regression in time (ImportLog). `values` has a row for each time, and
/// a column for each quantity.
class LocalPolynomial {
 public:
  LocalPolynomial(const std::vector<double>& time, const Eigen::MatrixXd& values, double half_width,
                  int degree)
      : time_(time), values_(values), half_width_(half_width), degree_(degree) {}

  /// At `at`, by rows of the stretch alone.
  [[nodiscard]] LocalFit At(double at, const LogStretch& stretch) const;

 private:
  const std::vector<double>& time_;
  const Eigen::MatrixXd& values_;
  double half_width_;
  int degree_;
};

}  // namespace trackbed
