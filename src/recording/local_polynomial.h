#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace trackbed {

/// Rows `first` to `end` (exclusive) without a gap longer than that of the map.
struct LogStretch {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<LogStretch> SplitAtGaps(const std::vector<double>& time, double gap);

/// Value, first and second derivative of the polynomials at one time: a row each, a column per
/// quantity.
using LocalFit = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Local weighted polynomial regression in time (ImportLog). `values` has a row per time and a
/// column per quantity.
class LocalPolynomial {
 public:
  LocalPolynomial(const std::vector<double>& time, const Eigen::MatrixXd& values, double half_width,
                  int degree)
      : time_(time), values_(values), half_width_(half_width), degree_(degree) {}

  /// The fit at time `at`, from the rows of the stretch only.
  [[nodiscard]] LocalFit At(double at, const LogStretch& stretch) const;

 private:
  const std::vector<double>& time_;
  const Eigen::MatrixXd& values_;
  double half_width_;
  int degree_;
};

}  // namespace trackbed
