#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "src/recording/local_polynomial.h"
#include "src/recording/log_rows.h"
#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Local polynomial fit of a signal that has its own timestamps; the fit can be evaluated at any
/// time. Before the first and after the last timestamp, the fitted value is constant.
class FittedSeries {
 public:
  FittedSeries(const LogSeries& series, const LogMap& map)
      : time_(series.time),
        values_(Eigen::Map<const Eigen::VectorXd>(series.value.data(),
                                                  static_cast<Eigen::Index>(series.value.size()))),
        all_{0, series.time.size()},
        fits_(time_, values_, map.resample.half_width, map.resample.degree) {}
  FittedSeries(const FittedSeries&) = delete;
  FittedSeries& operator=(const FittedSeries&) = delete;

  [[nodiscard]] LocalFit At(double at) const {
    return fits_.At(std::clamp(at, time_.front(), time_.back()), all_);
  }

 private:
  const std::vector<double>& time_;
  Eigen::MatrixXd values_;
  LogStretch all_;
  LocalPolynomial fits_;
};

}  // namespace trackbed
