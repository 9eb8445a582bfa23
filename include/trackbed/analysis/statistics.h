#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// What the rows of a study say about the distribution that they are a sample of.
namespace trackbed {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The score interval of the probability of success, after `passed` successes in `count`
/// independent trials, without continuity correction (Wilson 1927). [0, 1] if there were no trials.
///
/// PreconditionError unless passed <= count and confidence is in (0, 1).
Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence);

/// The values below which the given shares of a sample lie, interpolated linearly between its
/// members (type 7 of Hyndman and Fan 1996, as R and NumPy do by default).
///
/// PreconditionError unless there are values, all finite, and the shares are in [0, 1].
std::vector<double> Quantiles(std::vector<double> values, const std::vector<double>& shares);

/// The mean of a sample with the interval of the distribution's mean by Student's t; without an
/// interval of one value.
struct MeanEstimate {
  std::size_t count = 0;
  double mean = 0.0;
  std::optional<Interval> interval{};
};

/// PreconditionError unless there are values and confidence is in (0, 1).
MeanEstimate EstimateMean(const std::vector<double>& values, double confidence);

/// A parameter of a study as the analysis of variance takes it: to which of `count` classes each
/// row belongs.
struct Classes {
  std::vector<std::size_t> of_row;
  std::vector<std::string> names;  ///< one each: its value, or the median of its values
};

/// Each distinct text is a class if there are at most `most` or one is no number; otherwise the
/// rows, sorted by their number, are divided into `most` classes of equal size, up to ties, which
/// stay together.
///
/// PreconditionError unless most is at least 2.
Classes Classify(const std::vector<std::string>& values, std::size_t most);

/// The share of the variance of an output that a parameter explains by itself.
struct FirstOrderIndex {
  double index = 0.0;  ///< about 0 of one that has no influence, and then also below 0; at most 1
  Interval interval{};
};

struct IndexOptions {
  double confidence = 0.95;
  int resamples = 200;  ///< of the bootstrap, at least 2
};

/// First-order Sobol' indices Var(E[Y | X]) / Var(Y) from a given sample, whatever its design, one
/// for each parameter: the correlation ratio of the classes (Pearson 1905; Plischke, Borgonovo and
/// Smith 2013), less what classes of this size have by chance (Kelley 1935, epsilon squared), so
/// that a parameter without influence has the expectation 0. The parameters of the sample must be
/// independent. With B classes of a number an index is too small by about 1 / B^2 of itself.
///
/// The intervals are those of a normal distribution with the standard deviation of bootstrap
/// resamples (Efron and Tibshirani 1993), the same on every machine.
///
/// An index is nullopt if the output does not vary or the parameter has as many classes as rows.
/// PreconditionError unless all have as many rows. Cost: 2 ns per row, parameter and resample.
std::vector<std::optional<FirstOrderIndex>> FirstOrderIndices(
    const std::vector<Classes>& parameters, const std::vector<double>& output,
    const IndexOptions& options = {});

/// How far two lists of values rise together: Pearson's correlation of their ranks, equal values
/// sharing the mean of theirs (Spearman 1904).
struct RankCorrelation {
  double rho = 0.0;     ///< in [-1, 1]
  Interval interval{};  ///< by Fisher's transformation with the variance (1 + rho^2/2)/(n - 3) of
                        ///< Bonett and Wright (2000); of rho = 1 or -1 no wider than that
};

/// None of fewer than 4 pairs, or if one list does not vary. PreconditionError unless both have as
/// many values, all finite, and confidence is in (0, 1). Cost: that of sorting both.
std::optional<RankCorrelation> CorrelateRanks(const std::vector<double>& a,
                                              const std::vector<double>& b, double confidence);

/// How one list of values differs from another of the same conditions, b - a.
struct PairedDifference {
  MeanEstimate mean;
  double median = 0.0;
  std::size_t higher = 0;  ///< pairs in which b is above a
  std::size_t lower = 0;
  std::size_t equal = 0;
  /// The probability that as uneven a split of `higher` and `lower` comes by chance where neither
  /// is more likely: the exact two-sided sign test (Arbuthnott 1710), without equal pairs. 1 of
  /// none.
  double sign_test = 1.0;
};

/// PreconditionError unless both have as many values, at least one, and confidence is in (0, 1).
PairedDifference ComparePairs(const std::vector<double>& a, const std::vector<double>& b,
                              double confidence);

}  // namespace trackbed
