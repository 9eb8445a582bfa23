#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Statistics of the rows of a study, which are treated as a sample of a distribution.
namespace trackbed {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Computes the score interval (Wilson 1927) of a probability of success, without continuity
/// correction, from `passed` successes in `count` independent trials. Without trials, the interval
/// is [0, 1].
///
/// PreconditionError unless passed <= count and confidence is in (0, 1).
Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence);

/// Computes the quantiles of a sample at the fractions `shares`, interpolated linearly between the
/// values of the sample (type 7 of Hyndman and Fan 1996, the default of R and NumPy).
///
/// PreconditionError unless there are values, all finite, and the shares are in [0, 1].
std::vector<double> Quantiles(std::vector<double> values, const std::vector<double>& shares);

/// The mean of a sample, with Student's t interval for the mean of the distribution; a sample of
/// one value has no interval.
struct MeanEstimate {
  std::size_t count = 0;
  double mean = 0.0;
  std::optional<Interval> interval{};
};

/// Estimates the mean of a sample. PreconditionError unless there are values and confidence is in
/// (0, 1).
MeanEstimate EstimateMean(const std::vector<double>& values, double confidence);

/// A parameter of a study prepared for the analysis of variance: each row belongs to one of `count`
/// classes.
struct Classes {
  std::vector<std::size_t> of_row;
  /// Names of the classes: the value that all rows of a class share, or the median of their values.
  std::vector<std::string> names;
};

/// Divides the rows of a parameter into classes. If there are at most `max_classes` distinct texts,
/// or if one text is not a number, each distinct text is a class. Otherwise sorts the rows by
/// number and divides them into `max_classes` classes of equal size. Equal values stay in one
/// class.
///
/// PreconditionError unless max_classes is at least 2.
Classes Classify(const std::vector<std::string>& values, std::size_t max_classes);

/// The fraction of an output's variance that one parameter explains alone.
struct FirstOrderIndex {
  /// The index, at most 1. The index of a parameter without influence is about 0 and may be
  /// negative.
  double index = 0.0;
  Interval interval{};
};

struct IndexOptions {
  double confidence = 0.95;
  int resamples = 200;  ///< Number of bootstrap resamples, at least 2.
};

/// First-order Sobol' indices Var(E[Y | X]) / Var(Y), one per parameter, from a given sample of any
/// design. The estimate is the correlation ratio of the classes (Pearson 1905; Plischke, Borgonovo
/// and Smith 2013), minus its expectation by chance for classes of this size (Kelley 1935, epsilon
/// squared). The expected index of a parameter without influence is therefore 0. The parameters of
/// the sample must be independent. If a numeric parameter is divided into B classes, its index is
/// too small by a fraction of about 1 / B^2.
///
/// The confidence intervals assume a normal distribution with the standard deviation of the indices
/// of bootstrap resamples (Efron and Tibshirani 1993). The resamples are the same on every machine.
///
/// An index is nullopt if the output does not vary or the parameter has as many classes as rows.
/// PreconditionError unless the output and all parameters have the same number of rows. Cost: 2 ns
/// per row, parameter and resample.
std::vector<std::optional<FirstOrderIndex>> FirstOrderIndices(
    const std::vector<Classes>& parameters, const std::vector<double>& output,
    const IndexOptions& options = {});

/// Spearman's rank correlation of two lists (Spearman 1904): Pearson's correlation of their ranks;
/// equal values share their mean rank.
struct RankCorrelation {
  double rho = 0.0;  ///< Coefficient in [-1, 1].
  /// Interval by Fisher's transformation with the variance (1 + rho^2/2)/(n - 3) of Bonett and
  /// Wright (2000). The interval has zero width for rho = 1 or -1.
  Interval interval{};
};

/// Correlates two lists. Nullopt for fewer than 4 pairs, or if all values of one list are equal.
/// PreconditionError unless both lists have the same number of values, all finite, and confidence
/// is in (0, 1). Cost: that of sorting both lists.
std::optional<RankCorrelation> CorrelateRanks(const std::vector<double>& a,
                                              const std::vector<double>& b, double confidence);

/// The differences b - a of paired values measured under the same conditions.
struct PairedDifference {
  MeanEstimate mean;
  double median = 0.0;
  std::size_t higher = 0;  ///< Number of pairs in which b exceeds a.
  std::size_t lower = 0;
  std::size_t equal = 0;
  /// p-value of the exact two-sided sign test (Arbuthnott 1710), without equal pairs: the
  /// probability of a split at least as uneven as `higher` and `lower`, if both are equally likely.
  /// The p-value is 1 if all pairs are equal.
  double sign_test = 1.0;
};

/// Compares paired values. PreconditionError unless both lists have the same number of values, at
/// least one, and confidence is in (0, 1).
PairedDifference ComparePairs(const std::vector<double>& a, const std::vector<double>& b,
                              double confidence);

}  // namespace trackbed
