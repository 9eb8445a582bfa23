#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Samples the parameters of a study. A sample consists of points in the unit cube; distributions
/// convert each coordinate of a point to the value of a parameter.
namespace trackbed {

enum class SampleMethod {
  kRandom,  ///< Independent, uniformly distributed random points.
  /// Latin hypercube: the range of each coordinate is divided into `count` equal intervals, and
  /// each interval contains one point.
  kLatinHypercube,
  kSobol,  ///< A low-discrepancy sequence (Sobol'), shifted by a random amount.
};

/// Returns the name of a sampling method as written in files, such as "latin_hypercube".
const char* ToString(SampleMethod method);

struct SampleSpec {
  int count = 1;  ///< Number of points in the sample, at least 1.
  SampleMethod method = SampleMethod::kLatinHypercube;
  std::uint64_t seed = 1;
};

/// Makes a sample as a table with one row per point and one column per coordinate. All coordinates
/// of the sample are in (0, 1).
///
/// Guarantees: the same arguments give bit-identical samples on every machine. The numbers in a
/// column of the sample do not depend on the number of columns, so the values of a parameter stay
/// the same when another parameter is added. With kRandom and kSobol, the coordinates of a point
/// also do not depend on the number of points `count`. Each column is uniformly distributed for any
/// seed.
///
/// kLatinHypercube is the method of McKay, Beckman and Conover (1979): the intervals are permuted
/// at random, and the position in each interval is random. kSobol is the sequence of Sobol' (1967)
/// with the direction numbers of Joe and Kuo (2008), from Boost.Random. The Sobol' sequence
/// includes its first point (zero), so that samples whose number of points is a power of two are
/// stratified. A random digital shift (Cranley and Patterson 1976, in base 2) is applied to each
/// coordinate of the Sobol' sequence.
///
/// Throws PreconditionError unless `count` is positive and `dimensions` is 0 to 1000. Each number
/// of the sample takes 8 bytes and about 20 ns.
Eigen::MatrixXd UnitSample(const SampleSpec& spec, int dimensions);

enum class DistributionKind {
  kUniform,  ///< Uniform distribution from `from` to `to`.
  /// Log-uniform distribution: the logarithm is uniform from log(`from`) to log(`to`).
  kLogUniform,
  kInteger,  ///< Uniformly distributed whole number from `from` to `to`, including both.
  /// Normal distribution with `mean` and `deviation`, truncated at `min` and `max` if these are
  /// given.
  kNormal,
  kChoice,  ///< One of `values`, chosen at random with the given `weights` or with equal weights.
};

/// Returns the name of a distribution as written in files, such as "log_uniform".
const char* ToString(DistributionKind kind);

/// The distribution of a parameter.
struct Distribution {
  DistributionKind kind = DistributionKind::kUniform;
  double from = 0.0;
  double to = 1.0;
  /// Step of a uniform distribution: only the values `from` + k `step` (k = 0, 1, ...) occur, and
  /// all are equally likely. If the step is 0, all values of the range can occur.
  double step = 0.0;
  double mean = 0.0;
  /// Standard deviation of the normal distribution before it is truncated.
  double deviation = 1.0;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> values;  ///< Possible values, each as YAML on one line.
  /// Weights of the possible values; if empty, all values have equal weights.
  std::vector<double> weights;
};

/// Returns `from` + k `step`, rounded to 15 digits, so that 12 + 7 * 0.2 is 13.4.
double SteppedValue(double from, double step, double k);

/// Returns the quantile of the distribution at the probability `u` in (0, 1), as YAML. Numbers are
/// written in the shortest form from which the same double can be read.
std::string Quantile(const Distribution& distribution, double u);

}  // namespace trackbed
