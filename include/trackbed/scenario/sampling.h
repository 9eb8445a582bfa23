#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Samples of the parameters of a study: points of the unit cube, and distributions that map each
/// coordinate to a value.
namespace trackbed {

enum class SampleMethod {
  kRandom,          ///< independent points
  kLatinHypercube,  ///< each coordinate once in each of `count` equal intervals
  kSobol,           ///< a low-discrepancy sequence, shifted at random
};

/// The spelling in files, "latin_hypercube".
const char* ToString(SampleMethod method);

struct SampleSpec {
  int count = 1;  ///< points, at least 1
  SampleMethod method = SampleMethod::kLatinHypercube;
  std::uint64_t seed = 1;
};

/// One point per row and one coordinate per column, all in (0, 1).
///
/// Guarantees: the same arguments give the same bits on every machine. The coordinates of a column
/// do not depend on the number of columns, so that adding a parameter leaves the others unchanged;
/// those of kRandom and kSobol do not depend on `count` either. Each column is uniformly
/// distributed for any seed.
///
/// kLatinHypercube: McKay, Beckman and Conover (1979), a random permutation of the intervals and a
/// random place in each. kSobol: Sobol' (1967) with the direction numbers of Joe and Kuo (2008)
/// (Boost.Random), with the zero point, which stratifies counts that are powers of two, and a
/// random digital shift of each coordinate (Cranley and Patterson 1976, in base 2).
///
/// PreconditionError unless count is positive and dimensions is 0 to 1000.
/// Cost: 8 bytes and about 20 ns per coordinate.
Eigen::MatrixXd UnitSample(const SampleSpec& spec, int dimensions);

enum class DistributionKind {
  kUniform,     ///< from `from` to `to`
  kLogUniform,  ///< its logarithm is uniform
  kInteger,     ///< a whole number from `from` to `to`, both included
  kNormal,      ///< `mean` and `deviation`; truncated at `min` or `max` if given
  kChoice,      ///< one of `values`, with `weights` if given
};

/// The spelling in files, "log_uniform".
const char* ToString(DistributionKind kind);

/// The distribution of a parameter.
struct Distribution {
  DistributionKind kind = DistributionKind::kUniform;
  double from = 0.0;
  double to = 1.0;
  /// Of kUniform: values are `from` + k `step`, equally likely; 0: any value.
  double step = 0.0;
  double mean = 0.0;
  double deviation = 1.0;  ///< standard deviation before truncation
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> values;  ///< each as YAML on one line
  std::vector<double> weights;      ///< one per value; empty: equal weights
};

/// `from` + k `step`, rounded to 15 digits, so that 12 + 7 * 0.2 is 13.4.
double SteppedValue(double from, double step, double k);

/// The quantile of the distribution for `u` in (0, 1), as YAML: numbers in the shortest form that
/// reads back to the same double.
std::string Quantile(const Distribution& distribution, double u);

}  // namespace trackbed
