#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace trackbed {

/// Consecutive rows `first` to `end` (exclusive) of a log that contain no gap longer than the key
/// `gap` of the log's map.
struct LogStretch {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<LogStretch> SplitAtGaps(const std::vector<double>& time, double gap);

/// Matrix whose three rows contain the values, the first derivatives and the second derivatives of
/// the fitted polynomials at one time. A LocalFit has one column per fitted quantity.
using LocalFit = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Fits a weighted polynomial to the log rows near a time (local regression); used by ImportLog.
/// The matrix `values` has one row per time and one column per quantity.
class LocalPolynomial {
 public:
  LocalPolynomial(const std::vector<double>& time, const Eigen::MatrixXd& values, double half_width,
                  int degree)
      : time_(time), values_(values), half_width_(half_width), degree_(degree) {}

  /// Returns the values and derivatives of the fitted polynomials at time `at`, computed only from
  /// the rows of `stretch`.
  [[nodiscard]] LocalFit At(double at, const LogStretch& stretch) const;

 private:
  const std::vector<double>& time_;
  const Eigen::MatrixXd& values_;
  double half_width_;
  int degree_;
};

}  // namespace trackbed
