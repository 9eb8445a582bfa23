#include "src/recording/signal_delay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

// Estimates a delay by least squares: a scan over whole samples computes the sum of squared
// residuals for each delay. The delay is then refined by a cubic that is fitted to the sums of
// squared residuals around the chosen delay. The cubic extends over the delays that explain at
// least nine tenths of what the best delay explains, so noise of neighboring delays averages out.
// The standard error of the delay is that of an extremum estimator with correlated residuals (Newey
// and West 1987). Noise that varies faster than the motion can cause narrow peaks of correlation at
// random delays. If the reference explains too little of the signal, reference and signal are
// smoothed by moving averages of growing width. Equal moving averages of signal and reference do
// not change the delay between them.
namespace trackbed {
namespace {

/// Smallest share of the signal's variance that the reference must explain.
constexpr double kLeastExplained = 0.1;

/// Least-squares line signal = a reference + b through pairs of values.
struct Line {
  double a = 0.0;
  double b = 0.0;
  double residuals = 0.0;  // Sum of squared residuals of the line.
  double variance = 0.0;   // Sum of squared deviations of the signal from its mean.
  double count = 0.0;
};

/// The samples from which delays are estimated: the same samples of the signal at every delay.
class Scan {
 public:
  Scan(const std::vector<double>& reference, const std::vector<double>& signal,
       const std::vector<bool>& valid, int reach)
      : reference_(reference), signal_(signal), valid_(valid), reach_(reach) {}

  /// Calls `take(reference, signal, index)` for every `stride`-th valid pair of values at a delay
  /// in samples. In a valid pair, the neighbors of the reference value are valid, too.
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
      return {.residuals = yy, .variance = yy, .count = n};
    }
    const double a = xy / xx;
    return {.a = a,
            .b = mean_y - a * mean_x,
            .residuals = std::max(0.0, yy - a * xy),
            .variance = yy,
            .count = n};
  }

  /// Returns the slope of the reference at the sample `index`, per sample (CubicWeights).
  [[nodiscard]] double Slope(std::size_t index, const std::vector<double>& weights) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      sum += weights[k] * (reference_[index + k + 1] - reference_[index - k - 1]);
    }
    return sum;
  }

  /// Returns the reference at the time that is `part` sample periods before the sample `index`,
  /// with `part` from -1 to 1.
  [[nodiscard]] double Before(std::size_t index, double part) const {
    return part > 0.0 ? std::lerp(reference_[index], reference_[index - 1], part)
                      : std::lerp(reference_[index], reference_[index + 1], -part);
  }

  [[nodiscard]] int reach() const { return reach_; }

 private:
  const std::vector<double>& reference_;
  const std::vector<double>& signal_;
  const std::vector<bool>& valid_;
  int reach_;
};

/// Returns the correlation between neighboring values, clamped to 0 to 0.999.
double NeighborCorrelation(const std::vector<double>& values) {
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += values[i] * values[i];
    products += i > 0 ? values[i] * values[i - 1] : 0.0;
  }
  constexpr double kLargest = 0.999;
  return squares > 0.0 ? std::clamp(products / squares, 0.0, kLargest) : 0.0;
}

/// Returns the variance of the sum of correlated values with the mean 0 (Newey and West 1987). The
/// number of lags in the estimate is computed from the correlation of neighboring values by the
/// rule of Andrews (1991).
double VarianceOfSum(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  const double rho = NeighborCorrelation(values);
  const double alpha = 4.0 * rho * rho / ((1.0 - rho * rho) * (1.0 - rho * rho));
  const auto lags = static_cast<std::size_t>(std::min(1.1447 * std::cbrt(alpha * n), 0.1 * n));
  double sum = 0.0;
  for (std::size_t k = 0; k <= lags; ++k) {
    double covariance = 0.0;
    for (std::size_t i = k; i < values.size(); ++i) {
      covariance += values[i] * values[i - k];
    }
    const double weight = 1.0 - static_cast<double>(k) / static_cast<double>(lags + 1);
    sum += (k == 0 ? 1.0 : 2.0 * weight) * covariance;
  }
  return sum;
}

/// Returns weights w_k such that the sum of w_k (f(k) - f(-k)) over k from 1 to `width` is the
/// slope at 0 of the least-squares cubic through values f. The values f(k) are given at the
/// integers k from -`width` to `width` (Savitzky and Golay 1964). If `width` is 1, a parabola is
/// fitted instead of a cubic.
std::vector<double> CubicWeights(int width) {
  double s2 = 0.0;  // sums of k^2, k^4 and k^6 over the integers k from -width to width
  double s4 = 0.0;
  double s6 = 0.0;
  for (int k = 1; k <= width; ++k) {
    const double square = static_cast<double>(k) * k;
    s2 += 2.0 * square;
    s4 += 2.0 * square * square;
    s6 += 2.0 * square * square * square;
  }
  std::vector<double> weights;
  for (int k = 1; k <= width; ++k) {
    const double place = k;
    weights.push_back(width == 1 ? place / s2
                                 : (s6 * place - s4 * place * place * place) / (s2 * s6 - s4 * s4));
  }
  return weights;
}

/// Minimum of the sum of squared residuals over the delay, in samples.
struct Minimum {
  int middle = 0;      // Whole number of samples nearest to the delay at the minimum.
  double delay = 0.0;  // Delay at the minimum.
  double bend = 0.0;   // Second derivative of the sum of squared residuals at the minimum.
};

/// Finds the delay near `middle` at which the cubic through the sums of squared residuals, within
/// `width` samples of this delay, has no slope. The slope of the cubic is interpolated linearly
/// between samples.
Minimum FindMinimum(const Scan& scan, int middle, int width, int stride) {
  std::map<int, double> sums;
  const auto sum_at = [&](int delay) {
    const auto [at, is_new] = sums.try_emplace(delay, 0.0);
    if (is_new) {
      at->second = scan.Fit(delay, stride).residuals;
    }
    return at->second;
  };
  const std::vector<double> weights = CubicWeights(width);
  const auto slope_at = [&](int delay) {
    double slope = 0.0;
    for (int k = 1; k <= width; ++k) {
      slope += weights[static_cast<std::size_t>(k - 1)] * (sum_at(delay + k) - sum_at(delay - k));
    }
    return slope;
  };
  Minimum minimum{.middle = middle, .delay = static_cast<double>(middle)};
  // Search at most 2 `width` samples for the minimum, because the minimum is within the width of
  // the cubic.
  for (int step = 0; step < 2 * width; ++step) {
    const double slope = slope_at(minimum.middle);
    const int toward = slope > 0.0 ? -1 : 1;
    const double next = slope_at(minimum.middle + toward);
    minimum.bend = (next - slope) * toward;
    if (!(minimum.bend > 0.0)) {
      return minimum;
    }
    const double part = -slope / minimum.bend;
    minimum.delay = minimum.middle + std::clamp(part, -1.0, 1.0);
    if (std::abs(part) <= 0.5 || std::abs(minimum.middle + toward) + width + 1 > scan.reach()) {
      return minimum;
    }
    minimum.middle += toward;
  }
  return minimum;
}

/// Returns the standard error of the delay at the minimum of a cubic over +-`width`, in samples.
double StandardError(const Scan& scan, const Minimum& minimum, int width, int stride) {
  const Line line = scan.Fit(minimum.middle, stride);
  // Add the scores (products of residual and reference slope) in groups: the variance of the total
  // stays the same, and the number of groups bounds the cost.
  constexpr std::size_t kMaxScores = 20000;
  const std::size_t group = 1 + static_cast<std::size_t>(line.count) / kMaxScores;
  const std::vector<double> weights = CubicWeights(width);
  std::vector<double> scores;
  std::size_t count = 0;
  double squares = 0.0;  // Sum of squared signal values.
  double slopes = 0.0;   // Sum of squared slopes.
  const double part = minimum.delay - minimum.middle;
  scan.ForPairs(minimum.middle, stride, [&](double /*x*/, double y, std::size_t index) {
    if (count++ % group == 0) {
      scores.push_back(0.0);
    }
    const double slope = scan.Slope(index, weights);
    scores.back() += (y - line.a * scan.Before(index, part) - line.b) * slope;
    squares += y * y;
    slopes += slope * slope;
  });
  // Smallest relative rounding error of the numbers in a log.
  constexpr double kRounding = 1e-6;
  const double rounding = kRounding * kRounding * squares / line.count * slopes;
  const double information = 0.5 * minimum.bend / line.a;
  return information > 0.0 ? std::sqrt(VarianceOfSum(scores) + rounding) / information
                           : std::numeric_limits<double>::infinity();
}

/// Returns the number of independent samples that contain as much information as the samples of the
/// scan.
double IndependentSamples(const Scan& scan, int delay, const Line& line, int stride) {
  std::vector<double> residuals;
  scan.ForPairs(delay, stride, [&](double x, double y, std::size_t /*index*/) {
    residuals.push_back(y - line.a * x - line.b);
  });
  const double rho = NeighborCorrelation(residuals);
  return line.count * (1.0 - rho) / (1.0 + rho);
}

/// Returns the delay in samples whose sum of squared residuals is smallest. For periodic motion,
/// delays one period of the motion apart fit nearly equally well. The sum of squared residuals of
/// periodic motion has several minima, separated by delays that fit significantly worse. If other
/// minima of this sum are not significantly worse than the smallest one, returns the minimum with
/// the smallest absolute delay.
int BestDelay(const Scan& scan, const std::vector<Line>& lines, int stride) {
  const int reach = scan.reach();
  const auto at = [&](int delay) -> const Line& {
    return lines[static_cast<std::size_t>(delay + reach)];
  };
  int least = 0;
  for (int delay = -reach; delay <= reach; ++delay) {
    if (at(delay).a > 0.0 && at(delay).residuals < at(least).residuals) {
      least = delay;
    }
  }
  // Likelihood ratio test with one degree of freedom at three standard deviations.
  constexpr double kSignificant = 9.0;
  const double independent = IndependentSamples(scan, least, at(least), stride);
  const double worst = at(least).residuals * std::exp(kSignificant / std::max(1.0, independent));
  int best = least;
  const int none = reach + 1;
  int valley = none;  // best delay found after the last significantly worse delay of the scan
  for (int delay = -reach; delay <= reach; ++delay) {
    if (at(delay).a > 0.0 && at(delay).residuals <= worst) {
      valley = valley != none && at(valley).residuals <= at(delay).residuals ? valley : delay;
    }
    if (delay == reach || at(delay + 1).residuals > worst) {
      best = std::abs(valley) < std::abs(best) ? valley : best;
      valley = none;
    }
  }
  return best;
}

/// Returns the half width of the range of delays around `best` that explain at least nine tenths of
/// the variance that `best` explains. The returned half width is at least 1 sample.
int WidthOfCubic(const std::vector<Line>& lines, int reach, int best) {
  constexpr double kExplained = 0.9;
  const auto explained = [&](int delay) {
    const Line& line = lines[static_cast<std::size_t>(delay + reach)];
    return line.a > 0.0 ? line.variance - line.residuals : 0.0;
  };
  const double least = kExplained * explained(best);
  int width = 1;
  while (std::abs(best) + width + 2 < reach && explained(best - width - 1) >= least &&
         explained(best + width + 1) >= least) {
    ++width;
  }
  return width;
}

/// Returns whether the reference explains more of the signal's variance than pure noise would
/// explain at its best delay. The function IsSignificant applies a likelihood ratio test at three
/// standard deviations, corrected for the number of independent delays.
bool IsSignificant(const Scan& scan, int best, const Line& line, int stride) {
  constexpr double kSignificant = 9.0;
  const double independent = IndependentSamples(scan, best, line, stride);
  const double delays = std::max(1.0, 2.0 * scan.reach() * independent / (line.count * stride));
  return independent * std::log(line.variance / line.residuals) >
         kSignificant + 2.0 * std::log(delays);
}

/// The best delay, and the share of the signal's variance that it explains.
struct Estimate {
  std::optional<SignalDelay> found{};
  double explained = 0.0;  // explained share of the signal's variance
};

Estimate EstimateDelay(const std::vector<double>& reference, const std::vector<double>& signal,
                       const std::vector<bool>& valid, double period) {
  const int reach = static_cast<int>(std::ceil(kMaxSignalDelay / period));
  const int count = static_cast<int>(signal.size());
  // Largest numbers of samples for the scan and for the refinement of the delay, which bound the
  // computing time.
  constexpr int kScanned = 20000;
  constexpr int kRefined = 200000;
  const Scan scan(reference, signal, valid, reach);
  const int stride = 1 + count / kScanned;
  std::vector<Line> lines;
  for (int delay = -reach; delay <= reach; ++delay) {
    lines.push_back(scan.Fit(delay, stride));
  }
  const int best = BestDelay(scan, lines, stride);
  const Line& line = lines[static_cast<std::size_t>(best + reach)];
  Estimate estimate;
  if (!(line.a > 0.0) || !(line.variance > 0.0)) {
    return estimate;
  }
  estimate.explained = 1.0 - line.residuals / line.variance;
  if (estimate.explained <= kLeastExplained || std::abs(best) == reach ||
      !IsSignificant(scan, best, line, stride)) {
    return estimate;
  }
  const int width = WidthOfCubic(lines, reach, best);
  const int fine = 1 + count / kRefined;
  const Minimum minimum = FindMinimum(scan, best, width, fine);
  estimate.found =
      SignalDelay{minimum.delay * period, StandardError(scan, minimum, width, fine) * period};
  return estimate;
}

/// Returns the means of the values within `reach` samples to either side.
std::vector<double> Smoothed(const std::vector<double>& values, std::size_t reach) {
  std::vector<double> sums{0.0};
  for (const double value : values) {
    sums.push_back(sums.back() + value);
  }
  std::vector<double> means;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t from = i < reach ? 0 : i - reach;
    const std::size_t to = std::min(values.size(), i + reach + 1);
    means.push_back((sums[to] - sums[from]) / static_cast<double>(to - from));
  }
  return means;
}

/// Returns for each sample whether all samples within `reach` to either side are valid.
std::vector<bool> Inside(const std::vector<bool>& valid, std::size_t reach) {
  std::vector<double> values;
  for (const bool own : valid) {
    values.push_back(own ? 1.0 : 0.0);
  }
  std::vector<bool> inside;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    inside.push_back(i >= reach && i + reach < valid.size());
  }
  const std::vector<double> means = Smoothed(values, reach);
  for (std::size_t i = 0; i < valid.size(); ++i) {
    constexpr double kAll = 1.0 - 1e-9;
    inside[i] = inside[i] && means[i] > kAll;
  }
  return inside;
}

}  // namespace

std::optional<SignalDelay> FindDelay(const std::vector<double>& reference,
                                     const std::vector<double>& signal,
                                     const std::vector<bool>& valid, double period) {
  if (static_cast<double>(signal.size()) < 4.0 * std::ceil(kMaxSignalDelay / period)) {
    return std::nullopt;
  }
  // Largest time over which the moving averages extend to either side [s]. A moving average over a
  // longer time would also smooth out the motion itself.
  constexpr double kWidest = 0.5 * kMaxSignalDelay;
  constexpr double kMost = 0.8;  // explained share of the signal's variance above which signal and
                                 // reference need no smoothing
  Estimate estimate = EstimateDelay(reference, signal, valid, period);
  for (double reach = 0.125 * kWidest; estimate.explained < kMost && reach <= kWidest;
       reach *= 2.0) {
    const auto samples = static_cast<std::size_t>(std::lround(reach / period));
    if (samples > 0) {
      estimate = EstimateDelay(Smoothed(reference, samples), Smoothed(signal, samples),
                               Inside(valid, samples), period);
    }
  }
  return estimate.found;
}

}  // namespace trackbed
