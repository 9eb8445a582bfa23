#include "src/analysis/oscillation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

// Finds limit cycles of a control loop in the steering command.
//
// 1. A least-squares fit removes the part of the command that the inputs of the loop explain. The
//    inputs of the control loop are the feed-forward steering angle of the path (with any lead, lag
//    and gain) and the noise of the measured pose. 2. The unexplained remainder of the steering
//    command is searched for sustained oscillations, period by period. The autocorrelation of a
//    linear loop that noise excites has the shape of its free decay (the random decrement of Cole
//    1973). In a loop with the damping ratio z, an oscillation decays to the fraction exp(-2 pi z
//    M) of its amplitude within M cycles; a limit cycle keeps its whole amplitude.
namespace trackbed {
namespace {

using Series = std::vector<double>;

/// Number of cycles in each half of an oscillation; the two halves are compared. If the second half
/// of an oscillation has half of the first half's amplitude, the damping ratio is ln 2/(2 pi
/// kCycles) = 0.028.
constexpr int kCycles = 4;
constexpr double kShortestHalf = 2.0;  ///< Minimum duration of each half of an oscillation [s].
constexpr double kHalves = 0.9;        ///< Minimum correlation of the two halves of an oscillation.
/// Minimum correlation of neighboring cycles of an oscillation.
constexpr double kNeighbors = 0.9;
/// Minimum ratio of the amplitude in the second half of an oscillation to that in the first half.
constexpr double kLeastRemainder = 0.5;
constexpr double kLeastShare =
    0.5;  ///< Minimum ratio of the wave's amplitude in the command to that in the unexplained part.
constexpr double kPeriodStep =
    1.189207115002721;  ///< Ratio of two neighboring searched periods: a quarter octave.

/// Appends low-pass filtered copies of the input, with time constants in steps of a factor of 2.
/// The time constants of the filters range from one period to 3 s, or to the twentieth part of a
/// short signal. A filter that runs backward responds to the input's future.
void AddLowPasses(const Series& input, double period, bool backward, std::vector<Series>& out) {
  const std::size_t n = input.size();
  const double longest = std::min(3.0, 0.05 * static_cast<double>(n) * period);
  for (double constant = period; constant <= longest; constant *= 2.0) {
    const double decay = std::exp(-period / constant);
    Series filtered(n);
    double value = backward ? input.back() : input.front();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = backward ? n - 1 - i : i;
      value = decay * value + (1.0 - decay) * input[at];
      filtered[at] = value;
    }
    out.push_back(std::move(filtered));
  }
}

/// Subtracts from the signal its mean over `width` samples around each sample. The mean over a
/// whole period of an oscillation is zero, so an oscillation with the period `width` is not
/// changed.
Series WithoutSlowPart(const Series& signal, std::size_t width) {
  const std::size_t n = signal.size();
  Series sums(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    sums[i + 1] = sums[i] + signal[i];
  }
  Series rest(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i >= width / 2 ? i - width / 2 : 0;
    const std::size_t to = std::min(n, i + (width + 1) / 2);
    rest[i] = signal[i] - (sums[to] - sums[from]) / static_cast<double>(to - from);
  }
  return rest;
}

Series EveryNth(const Series& signal, std::size_t stride) {
  Series kept;
  for (std::size_t i = 0; i < signal.size(); i += stride) {
    kept.push_back(signal[i]);
  }
  return kept;
}

/// Sums of products of two signals over the last `length` samples. Each sample of the signal `late`
/// is multiplied by the sample of the signal `early` that is `lag` samples older.
class ProductSums {
 public:
  ProductSums(const Series& late, const Series& early, std::size_t lag, std::size_t length)
      : late_(late), early_(early), lag_(lag), length_(length) {}

  /// Adds the products of the sample `i`, and removes the products of the sample `i - length`. Call
  /// Advance for all samples in order, from `lag` on.
  void Advance(std::size_t i) {
    Add(i, 1.0);
    if (i >= lag_ + length_) {
      Add(i - length_, -1.0);
    }
  }

  [[nodiscard]] double product() const { return product_; }
  [[nodiscard]] double late() const { return late_squares_; }
  [[nodiscard]] double early() const { return early_squares_; }
  /// Returns whether the correlation coefficient of the two signals is at least `least`.
  [[nodiscard]] bool Correlate(double least) const {
    return late_squares_ > 0.0 && early_squares_ > 0.0 &&
           product_ >= least * std::sqrt(late_squares_ * early_squares_);
  }

 private:
  void Add(std::size_t i, double sign) {
    product_ += sign * late_[i] * early_[i - lag_];
    late_squares_ += sign * late_[i] * late_[i];
    early_squares_ += sign * early_[i - lag_] * early_[i - lag_];
  }

  const Series& late_;
  const Series& early_;
  std::size_t lag_;
  std::size_t length_;
  double product_ = 0.0;
  double late_squares_ = 0.0;
  double early_squares_ = 0.0;
};

/// A stretch of 2 `lag` samples of the unexplained command `x`. Correlates the stretch with copies
/// of itself that are shifted by `lag` samples and by one cycle, and with the command `y`.
class Stretch {
 public:
  Stretch(const Series& x, const Series& y, std::size_t lag, int cycles, bool random)
      : random_(random),
        x_(x),
        lag_(lag),
        cycles_(cycles),
        cycle_((lag + static_cast<std::size_t>(cycles) / 2) / static_cast<std::size_t>(cycles)),
        halves_(x, x, lag, lag),
        neighbors_(x, x, cycle_, 2 * lag - cycle_),
        in_command_(x, y, 0, lag),
        in_command_before_(x, y, 0, lag) {}

  /// Moves the end of the stretch to the sample `i`. Call Advance for all samples in order.
  void Advance(std::size_t i) {
    in_command_.Advance(i);
    if (i >= cycle_) {
      neighbors_.Advance(i);
    }
    if (i >= lag_) {
      in_command_before_.Advance(i - lag_);
      halves_.Advance(i);
      crossings_ += Crosses(i);
    }
    if (i >= 2 * lag_) {
      crossings_ -= Crosses(i - lag_);
    }
    complete_ = i + 1 >= 2 * lag_;
  }

  /// Returns whether the second half of the stretch repeats the first half; with random inputs,
  /// each cycle must repeat the previous cycle, too.
  [[nodiscard]] bool Repeats() const {
    // The second half of a wave has two sign changes per cycle; one sign change may be missing at
    // the ends of the half. A wave with a neighboring period would have an eighth more or fewer
    // sign changes. Cycles of few samples are not compared, because the period of a wave is not a
    // whole number of samples.
    constexpr std::size_t kFewSamples = 8;
    const bool compared = random_ && cycle_ >= kFewSamples;
    const double expected = 2.0 * cycles_;
    return complete_ && halves_.Correlate(kHalves) &&
           (!compared || neighbors_.Correlate(kNeighbors)) &&
           halves_.product() >= kLeastRemainder * halves_.early() &&
           in_command_.product() >= kLeastShare * in_command_.late() &&
           in_command_before_.product() >= kLeastShare * in_command_before_.late() &&
           std::abs(crossings_ - expected) <= std::max(1.0, expected / 8.0);
  }

  /// Returns the amplitude of the part of the signal that repeats in both halves of the stretch.
  [[nodiscard]] double Amplitude() const {
    return std::sqrt(2.0 * halves_.product() / static_cast<double>(lag_));
  }

 private:
  [[nodiscard]] int Crosses(std::size_t i) const {
    return (x_[i] > 0.0) != (x_[i - 1] > 0.0) ? 1 : 0;
  }

  bool random_;
  const Series& x_;
  std::size_t lag_;
  int cycles_;
  std::size_t cycle_;  // Samples of one cycle.
  ProductSums halves_;
  ProductSums neighbors_;
  ProductSums in_command_;         // Of the second half.
  ProductSums in_command_before_;  // Of the first half.
  int crossings_ = 0;
  bool complete_ = false;
};

/// Finds the largest wave of the unexplained command `x` that repeats after `lag` samples, with
/// `cycles` cycles in each half. The indices in the returned wave are sample numbers of the
/// unexplained command `x`.
std::optional<Wave> LargestWave(const Series& x, const Series& y, std::size_t lag, int cycles,
                                bool random) {
  std::optional<Wave> largest;
  Stretch stretch(x, y, lag, cycles, random);
  std::size_t begin = 0;
  bool continues = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    stretch.Advance(i);
    if (!stretch.Repeats()) {
      continues = false;
      continue;
    }
    begin = continues ? begin : i + 1 - 2 * lag;
    continues = true;
    const double amplitude = stretch.Amplitude();
    if (!largest || amplitude > largest->amplitude) {
      largest = Wave{amplitude, cycles / static_cast<double>(lag), begin, i};
    } else if (largest->first == begin) {
      largest->last = i;
    }
  }
  return largest;
}

/// Measures the frequency of the wave from the sign changes of `x`, and corrects the wave's
/// amplitude for the subtraction of the mean over `width` samples.
Wave Refine(const Wave& wave, const Series& x, double width) {
  std::size_t first = 0;
  std::size_t last = 0;
  int crossings = 0;
  for (std::size_t i = wave.first + 1; i <= wave.last; ++i) {
    if ((x[i] > 0.0) != (x[i - 1] > 0.0)) {
      first = crossings == 0 ? i : first;
      last = i;
      ++crossings;
    }
  }
  Wave refined = wave;
  refined.frequency = 0.5 * (crossings - 1) / static_cast<double>(last - first);
  const double turns = std::numbers::pi * refined.frequency * width;
  refined.amplitude = wave.amplitude / (1.0 - std::sin(turns) / turns);
  return refined;
}

}  // namespace

std::vector<double> UnexplainedCommand(const LoopSignals& signals) {
  std::vector<Series> inputs;
  for (const Series& input : signals.foreseen) {
    inputs.push_back(input);
    AddLowPasses(input, signals.period, false, inputs);
    AddLowPasses(input, signals.period, true, inputs);
  }
  for (const Series& input : signals.unforeseen) {
    inputs.push_back(input);
    AddLowPasses(input, signals.period, false, inputs);
  }
  const auto centered = [](const Series& series) {
    Eigen::VectorXd values =
        Eigen::Map<const Eigen::VectorXd>(series.data(), static_cast<Eigen::Index>(series.size()));
    values.array() -= values.mean();
    return values;
  };
  Eigen::VectorXd rest = centered(signals.command);
  Eigen::MatrixXd filters(rest.size(), static_cast<Eigen::Index>(inputs.size()));
  Eigen::Index used = 0;
  for (const Series& input : inputs) {
    const Eigen::VectorXd values = centered(input);
    constexpr double kNothing = 1e-9;  // Norm below which an input of the loop counts as constant.
    if (const double norm = values.norm(); norm > kNothing) {
      filters.col(used++) = values / norm;
    }
  }
  if (used > 0) {
    // The ridge term keeps the least-squares solution small if filters are linearly dependent.
    constexpr double kRidge = 1e-9;
    filters.conservativeResize(Eigen::NoChange, used);
    Eigen::MatrixXd gram = filters.transpose() * filters;
    gram.diagonal().array() += kRidge;
    rest -= filters * gram.ldlt().solve(filters.transpose() * rest);
  }
  return {rest.data(), rest.data() + rest.size()};
}

std::vector<Wave> FindWaves(const std::vector<double>& unexplained,
                            const std::vector<double>& command, double period, bool random) {
  // Minimum number of samples per cycle of an oscillation.
  constexpr std::size_t kSamplesPerCycle = 16;
  std::vector<Wave> waves;
  const double longest = static_cast<double>(unexplained.size()) / (2.0 * kCycles);
  for (double cycle = 2.0; cycle <= longest; cycle *= kPeriodStep) {
    const auto width = static_cast<std::size_t>(std::lround(cycle));
    const std::size_t stride = std::max<std::size_t>(1, width / kSamplesPerCycle);
    const Series x = EveryNth(WithoutSlowPart(unexplained, width), stride);
    const Series y = EveryNth(WithoutSlowPart(command, width), stride);
    const int cycles =
        std::max(kCycles, static_cast<int>(std::ceil(kShortestHalf / (cycle * period))));
    const double lag = cycles * cycle / static_cast<double>(stride);
    // The tried periods range from cycle/halfway to cycle*halfway.
    const double halfway = std::sqrt(kPeriodStep);
    const auto most = std::min(x.size() / 2, static_cast<std::size_t>(std::ceil(lag * halfway)));
    std::optional<Wave> best;
    for (auto own = static_cast<std::size_t>(lag / halfway); own <= most; ++own) {
      const std::optional<Wave> found = LargestWave(x, y, own, cycles, random);
      if (found && (!best || found->amplitude > best->amplitude)) {
        best = found;
      }
    }
    if (best) {
      const auto samples = static_cast<double>(stride);
      const Wave wave = Refine(*best, x, static_cast<double>(width) / samples);
      waves.push_back({wave.amplitude, wave.frequency / (samples * period), wave.first * stride,
                       wave.last * stride});
    }
  }
  return waves;
}

}  // namespace trackbed
