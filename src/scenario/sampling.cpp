#include "trackbed/scenario/sampling.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

constexpr int kMaxDimensions = 1000;

/// Returns an independent random number generator for one coordinate of a sample. The C++ standard
/// specifies the generator and its seeding exactly, so that samples are equal on all platforms. The
/// C++ standard does not specify exactly how distributions are computed, so Trackbed implements its
/// own distributions.
std::mt19937_64 StreamOf(std::uint64_t seed, int dimension) {
  constexpr unsigned kHalf = 32;
  std::seed_seq sequence{static_cast<std::uint32_t>(seed),
                         static_cast<std::uint32_t>(seed >> kHalf),
                         static_cast<std::uint32_t>(dimension)};
  return std::mt19937_64(sequence);
}

/// Converts 64 random bits to a number between 0 and 1 (exclusive): the midpoint of one of 2^52
/// equal intervals.
double Unit(std::uint64_t bits) {
  constexpr unsigned kDroppedBits = 12;
  constexpr int kKeptBits = 52;
  return std::ldexp(static_cast<double>(bits >> kDroppedBits) + 0.5, -kKeptBits);
}

/// Returns a random permutation of the integers 0 to count - 1 (Fisher and Yates, in Durstenfeld's
/// form).
std::vector<int> Permutation(int count, std::mt19937_64& stream) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) {
    // The modulo operation makes some permutations slightly more likely, but this bias is less than
    // count / 2^64.
    std::swap(order[i - 1], order[stream() % i]);
  }
  return order;
}

Eigen::MatrixXd Random(const SampleSpec& spec, int dimensions) {
  Eigen::MatrixXd sample(spec.count, dimensions);
  for (int j = 0; j < dimensions; ++j) {
    std::mt19937_64 stream = StreamOf(spec.seed, j);
    for (int i = 0; i < spec.count; ++i) {
      sample(i, j) = Unit(stream());
    }
  }
  return sample;
}

Eigen::MatrixXd LatinHypercube(const SampleSpec& spec, int dimensions) {
  Eigen::MatrixXd sample(spec.count, dimensions);
  // Largest floating-point number (double) below 1; a sample coordinate that rounding has raised to
  // 1 is replaced by this number.
  const double largest = std::nextafter(1.0, 0.0);
  for (int j = 0; j < dimensions; ++j) {
    std::mt19937_64 stream = StreamOf(spec.seed, j);
    const std::vector<int> order = Permutation(spec.count, stream);
    for (int i = 0; i < spec.count; ++i) {
      const double place = order[static_cast<std::size_t>(i)] + Unit(stream());
      sample(i, j) = std::min(place / spec.count, largest);
    }
  }
  return sample;
}

Eigen::MatrixXd Sobol(const SampleSpec& spec, int dimensions) {
  std::vector<std::uint64_t> shifts;
  for (int j = 0; j < dimensions; ++j) {
    shifts.push_back(StreamOf(spec.seed, j)());
  }
  boost::random::sobol sequence(static_cast<std::size_t>(dimensions));
  Eigen::MatrixXd sample(spec.count, dimensions);
  for (int i = 0; i < spec.count; ++i) {
    for (int j = 0; j < dimensions; ++j) {
      // Add the first point of the Sobol sequence, which is 0 in all coordinates, because Boost
      // omits this point.
      const std::uint64_t number = i == 0 ? 0 : sequence();
      sample(i, j) = Unit(number ^ shifts[static_cast<std::size_t>(j)]);
    }
  }
  return sample;
}

/// Makes Boost compute with doubles only, because Boost's tables of long doubles overflow at
/// startup if long doubles have only 64 bits, as under valgrind.
using DoublePrecision = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

double NormalQuantile(const Distribution& distribution, double u) {
  const boost::math::normal_distribution<double, DoublePrecision> normal(distribution.mean,
                                                                         distribution.deviation);
  const double below = std::isinf(distribution.min) ? 0.0 : cdf(normal, distribution.min);
  const double up_to = std::isinf(distribution.max) ? 1.0 : cdf(normal, distribution.max);
  const double share = below + u * (up_to - below);
  // If both bounds are in the far tail of the normal distribution, their cumulative probabilities
  // both round to 0 or both to 1. If the cumulative probabilities of both bounds round to the same
  // value, return the bound that is nearer to the mean.
  if (!(share > 0.0)) {
    return distribution.max;
  }
  if (!(share < 1.0)) {
    return distribution.min;
  }
  return std::clamp(quantile(normal, share), distribution.min, distribution.max);
}

const std::string& SampleChoice(const Distribution& distribution, double u) {
  const std::size_t count = distribution.values.size();
  if (distribution.weights.empty()) {
    return distribution
        .values[std::min(static_cast<std::size_t>(u * static_cast<double>(count)), count - 1)];
  }
  const double sum = std::accumulate(distribution.weights.begin(), distribution.weights.end(), 0.0);
  double below = 0.0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    below += distribution.weights[i] / sum;
    if (u < below) {
      return distribution.values[i];
    }
  }
  return distribution.values.back();
}

}  // namespace

const char* ToString(SampleMethod method) {
  switch (method) {
    case SampleMethod::kRandom:
      return "random";
    case SampleMethod::kLatinHypercube:
      return "latin_hypercube";
    case SampleMethod::kSobol:
      return "sobol";
  }
  TRACKBED_CHECK(false, "method {}", static_cast<int>(method));
}

const char* ToString(DistributionKind kind) {
  switch (kind) {
    case DistributionKind::kUniform:
      return "uniform";
    case DistributionKind::kLogUniform:
      return "log_uniform";
    case DistributionKind::kInteger:
      return "integer";
    case DistributionKind::kNormal:
      return "normal";
    case DistributionKind::kChoice:
      return "choice";
  }
  TRACKBED_CHECK(false, "distribution {}", static_cast<int>(kind));
}

Eigen::MatrixXd UnitSample(const SampleSpec& spec, int dimensions) {
  TRACKBED_REQUIRE(spec.count > 0, "UnitSample: count is {}; must be positive", spec.count);
  TRACKBED_REQUIRE(dimensions >= 0 && dimensions <= kMaxDimensions,
                   "UnitSample: dimensions is {}; must be 0 to {}", dimensions, kMaxDimensions);
  if (dimensions == 0) {
    return {spec.count, 0};
  }
  switch (spec.method) {
    case SampleMethod::kRandom:
      return Random(spec, dimensions);
    case SampleMethod::kLatinHypercube:
      return LatinHypercube(spec, dimensions);
    case SampleMethod::kSobol:
      return Sobol(spec, dimensions);
  }
  TRACKBED_CHECK(false, "method {}", static_cast<int>(spec.method));
}

double SteppedValue(double from, double step, double k) {
  const double value = from + k * step;
  return CellNumber(fmt::format("{:.15g}", value)).value_or(value);
}

std::string Quantile(const Distribution& distribution, double u) {
  const double from = distribution.from;
  const double to = distribution.to;
  switch (distribution.kind) {
    case DistributionKind::kUniform:
      if (distribution.step > 0.0) {
        const double last = std::round((to - from) / distribution.step);
        return ShortestText(
            SteppedValue(from, distribution.step, std::min(std::floor(u * (last + 1.0)), last)));
      }
      return ShortestText(from + u * (to - from));
    case DistributionKind::kLogUniform:
      return ShortestText(std::clamp(from * std::pow(to / from, u), from, to));
    case DistributionKind::kInteger:
      return ShortestText(std::min(from + std::floor(u * (to - from + 1.0)), to));
    case DistributionKind::kNormal:
      return ShortestText(NormalQuantile(distribution, u));
    case DistributionKind::kChoice:
      return SampleChoice(distribution, u);
  }
  TRACKBED_CHECK(false, "distribution {}", static_cast<int>(distribution.kind));
}

}  // namespace trackbed
