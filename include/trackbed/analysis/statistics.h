#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Statistics of a study. The rows of the study are treated as a random sample of a distribution.
namespace trackbed {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Computes the confidence interval of a probability of success from `passed` successes in `count`
/// independent trials, by the score method of Wilson (1927) without continuity correction. If the
/// number of trials `count` is 0, the confidence interval is [0, 1].
///
/// Throws PreconditionError unless passed <= count and confidence is in (0, 1).
Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence);

/// Computes the quantiles of a sample at the fractions `shares`. The quantiles are interpolated
/// linearly between the values of the sample (type 7 of Hyndman and Fan 1996, the default of R and
/// NumPy).
///
/// Throws PreconditionError if there are no values, if a value is not finite, or if a share is not
/// in [0, 1].
std::vector<double> Quantiles(std::vector<double> values, const std::vector<double>& shares);

/// The mean of a sample, with Student's t confidence interval for the mean of the distribution. A
/// sample of one value has no confidence interval.
struct MeanEstimate {
  std::size_t count = 0;
  double mean = 0.0;
  std::optional<Interval> interval{};
};

/// Estimates the mean of a distribution from a sample. Throws PreconditionError if there are no
/// values, or if `confidence` is not in (0, 1).
MeanEstimate EstimateMean(const std::vector<double>& values, double confidence);

/// The rows of a study, divided into classes by the value of one parameter, for the analysis of
/// variance.
struct Classes {
  std::vector<std::size_t> of_row;
  /// Name of each class: the parameter value that all rows of the class have, or the median of
  /// their values.
  std::vector<std::string> names;
};

/// Divides the rows of a study into classes by the values of a parameter. If there are at most
/// `max_classes` distinct values, or if a value is not a number, each distinct value is a class.
/// If there are more than `max_classes` distinct values, all of them numbers, the rows are sorted
/// by value and divided into `max_classes` classes of equal size. Rows with equal values are always
/// in the same class.
///
/// Throws PreconditionError unless max_classes is at least 2.
Classes Classify(const std::vector<std::string>& values, std::size_t max_classes);

/// First-order index: the fraction of an output's variance that is explained by one parameter
/// alone.
struct FirstOrderIndex {
  /// First-order Sobol' index of the parameter, at most 1. The index of a parameter without
  /// influence is about 0 and may be negative.
  double index = 0.0;
  Interval interval{};
};

struct IndexOptions {
  double confidence = 0.95;
  int resamples = 200;  ///< Number of bootstrap resamples, at least 2.
};

/// Estimates the first-order Sobol' index Var(E[Y | X]) / Var(Y) of each parameter X on the output
/// Y, from a given sample of any design. The estimate is the correlation ratio of the classes
/// (Pearson 1905; Plischke, Borgonovo and Smith 2013). From the estimate, the correlation ratio
/// expected by chance is subtracted (Kelley 1935, epsilon squared), so the expected index of a
/// parameter without influence is 0. The parameters of the sample must be independent. If a numeric
/// parameter is divided into B classes, the estimated index is too small by a fraction of about 1 /
/// B^2.
///
/// The confidence intervals assume that the estimate is normally distributed. The standard
/// deviation of the estimate is computed from bootstrap resamples (Efron and Tibshirani 1993),
/// which are the same on every machine.
///
/// The index of a parameter is nullopt if the output does not vary, or if the parameter has as many
/// classes as rows. Throws PreconditionError unless the output and all parameters have the same
/// number of rows. Cost: 2 ns per row, parameter and resample.
std::vector<std::optional<FirstOrderIndex>> FirstOrderIndices(
    const std::vector<Classes>& parameters, const std::vector<double>& output,
    const IndexOptions& options = {});

/// Rank correlation of two lists (Spearman 1904), which is Pearson's correlation of the ranks.
/// Equal values share their mean rank.
struct RankCorrelation {
  double rho = 0.0;  ///< Spearman's correlation coefficient rho, in [-1, 1].
  /// Confidence interval of rho by Fisher's transformation, with the variance (1 + rho^2/2)/(n - 3)
  /// of Bonett and Wright (2000). The confidence interval of rho has zero width if rho is 1 or -1.
  Interval interval{};
};

/// Computes the rank correlation of two lists. Returns nullopt if there are fewer than 4 pairs, or
/// if all values of one list are equal. Throws PreconditionError if the lists have different
/// lengths, if a value is not finite, or if `confidence` is not in (0, 1). Cost: O(n log n) for n
/// pairs, for sorting both lists.
std::optional<RankCorrelation> CorrelateRanks(const std::vector<double>& a,
                                              const std::vector<double>& b, double confidence);

/// The differences b - a of paired values measured under the same conditions.
struct PairedDifference {
  MeanEstimate mean;
  double median = 0.0;
  std::size_t higher = 0;  ///< Number of pairs in which b exceeds a.
  std::size_t lower = 0;
  std::size_t equal = 0;
  /// The p-value of the exact two-sided sign test (Arbuthnott 1710), which ignores pairs of equal
  /// values. The p-value is the probability that the pairs are split at least as unevenly as
  /// `higher` to `lower`, if both signs are equally likely. The p-value is 1 if every pair consists
  /// of equal values.
  double sign_test = 1.0;
};

/// Compares paired values. Throws PreconditionError if the lists are empty or have different
/// lengths, or if `confidence` is not in (0, 1).
PairedDifference ComparePairs(const std::vector<double>& a, const std::vector<double>& b,
                              double confidence);

}  // namespace trackbed
