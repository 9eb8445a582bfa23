#include "src/recording/signal_delay.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "trackbed/geometry/pose.h"

// Estimates a delay by least squares: a scan over whole samples finds the smallest sum of squared
// residuals, and a parabola through the sums at this delay and at both neighbors refines the delay.
namespace trackbed {
namespace {

/// Least-squares line signal = a reference + b through pairs of values.
struct Line {
  double a = 0.0;
  double b = 0.0;
  double residuals = 0.0;  // sum of squared residuals
  double variance = 0.0;   // sum of squared deviations of the signal from its mean
};

/// The samples from which delays are estimated: the same samples of the signal at every delay.
class Scan {
 public:
  Scan(const std::vector<double>& reference, const std::vector<double>& signal,
       const std::vector<bool>& valid, int reach)
      : reference_(reference), signal_(signal), valid_(valid), reach_(reach) {}

  /// Calls `take(reference, signal, index)` for every `stride`-th valid pair at a delay in samples.
  /// The neighbors of a pair's reference are valid, too.
  template <typename Take>
  void ForPairs(int delay, int stride, const Take& take) const {
    const int count = static_cast<int>(signal_.size());
    for (int i = reach_ + 1; i + reach_ + 1 < count; i += stride) {
      const auto now = static_cast<std::size_t>(i);
      const auto before = static_cast<std::size_t>(i - delay);
      if (valid_[now] && valid_[before - 1] && valid_[before] && valid_[before + 1]) {
        take(reference_[before], signal_[now], before);
      }
    }
  }

  [[nodiscard]] Line Fit(int delay, int stride) const {
    double n = 0.0;
    double mean_x = 0.0;
    double mean_y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    ForPairs(delay, stride, [&](double x, double y, std::size_t /*index*/) {
      // Welford's update of means and co-moments.
      n += 1.0;
      const double dx = x - mean_x;
      const double dy = y - mean_y;
      mean_x += dx / n;
      mean_y += dy / n;
      xx += dx * (x - mean_x);
      xy += dx * (y - mean_y);
      yy += dy * (y - mean_y);
    });
    if (!(xx > 0.0)) {
      return {.residuals = yy, .variance = yy};
    }
    const double a = xy / xx;
    return {a, mean_y - a * mean_x, std::max(0.0, yy - a * xy), yy};
  }

 private:
  const std::vector<double>& reference_;
  const std::vector<double>& signal_;
  const std::vector<bool>& valid_;
  int reach_;
};

/// Returns the standard error of the delay, in samples.
double StandardError(const Scan& scan, int delay, const Line& line,
                     const std::vector<double>& reference) {
  double n = 0.0;
  double squares = 0.0;   // sum of squared signal values
  double products = 0.0;  // sum of products of neighboring residuals
  double last = 0.0;
  Vec2 mean = Vec2::Zero();                           // of the reference and of its derivative
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();  // co-moments about the mean
  scan.ForPairs(delay, 1, [&](double x, double y, std::size_t index) {
    const double residual = y - line.a * x - line.b;
    products += n > 0.0 ? residual * last : 0.0;
    last = residual;
    squares += y * y;
    n += 1.0;
    const Vec2 values(x, 0.5 * (reference[index + 1] - reference[index - 1]));
    const Vec2 off = values - mean;
    mean += off / n;
    moments += off * (values - mean).transpose();
  });
  // The part of the derivative that neither a change of a nor a change of b can replace. For a
  // reference that is linear in time, this part is zero, and no delay can be found.
  const double own = moments(1, 1) - moments(0, 1) * moments(0, 1) / moments(0, 0);
  constexpr double kLargestCorrelation = 0.999;
  const double rho =
      line.residuals > 0.0 ? std::clamp(products / line.residuals, 0.0, kLargestCorrelation) : 0.0;
  // Logs have at least this relative rounding error.
  constexpr double kRounding = 1e-6;
  const double sigma =
      std::sqrt(line.residuals / std::max(1.0, n - 3.0)) + kRounding * std::sqrt(squares / n);
  return sigma / (line.a * std::sqrt(std::max(0.0, own))) * std::sqrt((1.0 + rho) / (1.0 - rho));
}

}  // namespace

std::optional<SignalDelay> FindDelay(const std::vector<double>& reference,
                                     const std::vector<double>& signal,
                                     const std::vector<bool>& valid, double period) {
  const int reach = static_cast<int>(std::ceil(kMaxSignalDelay / period));
  const int count = static_cast<int>(signal.size());
  if (count < 4 * reach) {
    return std::nullopt;
  }
  // The scan takes at most this number of samples, which bounds its cost. The chosen delay is then
  // refined over all samples.
  constexpr int kScanned = 20000;
  const Scan scan(reference, signal, valid, reach);
  const int stride = 1 + count / kScanned;
  int best = 0;
  double least = scan.Fit(0, stride).residuals;
  for (int delay = -reach; delay <= reach; ++delay) {
    const Line line = scan.Fit(delay, stride);
    if (line.a > 0.0 && line.residuals < least) {
      least = line.residuals;
      best = delay;
    }
  }
  const Line line = scan.Fit(best, 1);
  const bool explained = line.residuals < 0.5 * line.variance;
  if (!(line.a > 0.0) || !explained || std::abs(best) == reach) {
    return std::nullopt;
  }
  const double before = scan.Fit(best - 1, 1).residuals;
  const double after = scan.Fit(best + 1, 1).residuals;
  const double bend = before - 2.0 * line.residuals + after;
  const double part = bend > 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  return SignalDelay{(best + part) * period, StandardError(scan, best, line, reference) * period};
}

}  // namespace trackbed
