#include "trackbed/analysis/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

// Computes statistics of study tables. Confidence intervals of pass rates are Wilson score
// intervals (Wilson 1927). Quantiles are interpolated linearly between order statistics. Confidence
// intervals of means use Student's t distribution. Classify assigns the values of a parameter to
// classes: one class per distinct value, or classes of about equal size if there are many distinct
// values. FirstOrderIndices computes the fraction of an output's variance that lies between classes
// (epsilon squared). The confidence interval of epsilon squared assumes a normal distribution,
// whose standard deviation is estimated by bootstrap resampling. CorrelateRanks computes the rank
// correlation (Spearman 1904) with the confidence interval of Bonett and Wright (2000).
// ComparePairs computes paired differences and the sign test.
namespace trackbed {
namespace {

/// Makes Boost compute with doubles only, because Boost's tables of long doubles overflow at
/// startup if long doubles have only 64 bits, as under valgrind.
using DoublePrecision = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// Returns the half width of a confidence interval of a normally distributed quantity, as a
/// multiple of the standard deviation.
double NormalReach(double confidence) {
  TRACKBED_REQUIRE(confidence > 0.0 && confidence < 1.0, "confidence {} is not in (0, 1)",
                   confidence);
  return boost::math::quantile(boost::math::normal_distribution<double, DoublePrecision>(),
                               0.5 * (1.0 + confidence));
}

double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Computes epsilon squared of an output whose mean is near 0. For n rows in B classes, epsilon
/// squared is 1 - (W / (n - B)) / (T / (n - 1)), where W and T are the sums of squared deviations
/// from the class means and from the total mean.
class VarianceShare {
 public:
  explicit VarianceShare(std::size_t classes) : counts_(classes), sums_(classes) {}

  void Clear() {
    std::fill(counts_.begin(), counts_.end(), 0.0);
    std::fill(sums_.begin(), sums_.end(), 0.0);
  }
  void Add(std::size_t its_class, double value) {
    counts_[its_class] += 1.0;
    sums_[its_class] += value;
  }
  /// Returns epsilon squared. The argument `squares` is the sum of the squares of all added values.
  [[nodiscard]] std::optional<double> Share(double squares) const {
    double rows = 0.0;
    double sum = 0.0;
    double between = 0.0;
    double classes = 0.0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (counts_[i] > 0.0) {
        rows += counts_[i];
        sum += sums_[i];
        between += sums_[i] * sums_[i] / counts_[i];
        classes += 1.0;
      }
    }
    const double total = squares - sum * sum / rows;
    if (rows <= classes || !(total > 1e-12 * squares)) {
      return std::nullopt;
    }
    return 1.0 - (squares - between) / (rows - classes) * (rows - 1.0) / total;
  }

 private:
  std::vector<double> counts_;
  std::vector<double> sums_;
};

}  // namespace

Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence) {
  TRACKBED_REQUIRE(passed <= count, "{} of {} passed", passed, count);
  const double z = NormalReach(confidence);
  if (count == 0) {
    return {0.0, 1.0};
  }
  const auto n = static_cast<double>(count);
  const double p = static_cast<double>(passed) / n;
  const double scale = 1.0 + z * z / n;
  const double center = (p + z * z / (2.0 * n)) / scale;
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / scale;
  // Avoid rounding errors at the ends of the interval: the lower end is exactly 0 if no run passed,
  // and the upper end is exactly 1 if all runs passed.
  return {passed == 0 ? 0.0 : std::max(0.0, center - half),
          passed == count ? 1.0 : std::min(1.0, center + half)};
}

std::vector<double> Quantiles(std::vector<double> values, const std::vector<double>& shares) {
  TRACKBED_REQUIRE(!values.empty(), "quantiles of no value");
  TRACKBED_REQUIRE(
      std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }),
      "a value is not finite");
  std::sort(values.begin(), values.end());
  std::vector<double> quantiles;
  for (const double share : shares) {
    TRACKBED_REQUIRE(share >= 0.0 && share <= 1.0, "share {} is not in [0, 1]", share);
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    quantiles.push_back(std::lerp(values[below], values[above], place - std::floor(place)));
  }
  return quantiles;
}

MeanEstimate EstimateMean(const std::vector<double>& values, double confidence) {
  TRACKBED_REQUIRE(!values.empty(), "the mean of no value");
  TRACKBED_REQUIRE(confidence > 0.0 && confidence < 1.0, "confidence {} is not in (0, 1)",
                   confidence);
  MeanEstimate estimate{.count = values.size(), .mean = MeanOf(values)};
  if (values.size() > 1) {
    double squares = 0.0;
    for (const double value : values) {
      squares += (value - estimate.mean) * (value - estimate.mean);
    }
    const auto n = static_cast<double>(values.size());
    const double t = boost::math::quantile(
        boost::math::students_t_distribution<double, DoublePrecision>(n - 1.0),
        0.5 * (1.0 + confidence));
    const double half = t * std::sqrt(squares / (n - 1.0) / n);
    estimate.interval = Interval{estimate.mean - half, estimate.mean + half};
  }
  return estimate;
}

Classes Classify(const std::vector<std::string>& values, std::size_t max_classes) {
  TRACKBED_REQUIRE(max_classes >= 2, "{} classes", max_classes);
  Classes classes;
  classes.of_row.resize(values.size());
  std::map<std::string, std::size_t> distinct;
  std::vector<std::pair<double, std::size_t>> numbers;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const auto [found, is_new] = distinct.try_emplace(values[row], distinct.size());
    classes.of_row[row] = found->second;
    if (is_new) {
      classes.names.push_back(values[row]);
    }
    if (const std::optional<double> number = CellNumber(values[row])) {
      numbers.emplace_back(*number, row);
    }
  }
  if (distinct.size() <= max_classes || numbers.size() < values.size()) {
    return classes;
  }
  std::sort(numbers.begin(), numbers.end());
  classes.names.clear();
  for (std::size_t begin = 0; begin < numbers.size();) {
    // Divide the remaining rows evenly among the remaining classes.
    const std::size_t left =
        std::max<std::size_t>(1, max_classes - std::min(max_classes, classes.names.size()));
    std::size_t end = begin + std::max<std::size_t>(1, (numbers.size() - begin) / left);
    while (end < numbers.size() && numbers[end].first == numbers[end - 1].first) {
      ++end;
    }
    for (std::size_t i = begin; i < end; ++i) {
      classes.of_row[numbers[i].second] = classes.names.size();
    }
    classes.names.push_back(values[numbers[begin + (end - begin) / 2].second]);
    begin = end;
  }
  return classes;
}

std::vector<std::optional<FirstOrderIndex>> FirstOrderIndices(
    const std::vector<Classes>& parameters, const std::vector<double>& output,
    const IndexOptions& options) {
  TRACKBED_REQUIRE(options.resamples >= 2, "{} resamples", options.resamples);
  const double z = NormalReach(options.confidence);
  std::vector<std::optional<FirstOrderIndex>> indices(parameters.size());
  if (output.empty()) {
    return indices;
  }
  // Subtract the mean from the values, so that a large mean does not cause cancellation in the sums
  // of squares.
  std::vector<double> values = output;
  const double mean = MeanOf(values);
  std::vector<VarianceShare> shares;
  double squares = 0.0;
  for (double& value : values) {
    value -= mean;
    squares += value * value;
  }
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Classes& classes = parameters[p];
    TRACKBED_REQUIRE(classes.of_row.size() == values.size(),
                     "{} rows of a parameter, {} of the output", classes.of_row.size(),
                     values.size());
    shares.emplace_back(classes.names.size());
    for (std::size_t row = 0; row < values.size(); ++row) {
      shares[p].Add(classes.of_row[row], values[row]);
    }
    // Skip an output that varies only by rounding errors.
    const double rounding = 1e-12 * std::abs(mean);
    if (squares <= rounding * rounding * static_cast<double>(values.size())) {
      continue;
    }
    if (const std::optional<double> index = shares[p].Share(squares)) {
      indices[p] = FirstOrderIndex{.index = *index};
    }
  }
  // A fixed seed makes the bootstrap intervals reproducible.
  std::mt19937_64 random(1);  // NOLINT(cert-msc51-cpp)
  std::vector<std::vector<double>> resampled(parameters.size());
  for (int resample = 0; resample < options.resamples; ++resample) {
    for (VarianceShare& share : shares) {
      share.Clear();
    }
    double own_squares = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Draw a row number below values.size() from the upper 32 random bits.
      const std::size_t row = ((random() >> 32U) * values.size()) >> 32U;
      own_squares += values[row] * values[row];
      for (std::size_t p = 0; p < parameters.size(); ++p) {
        shares[p].Add(parameters[p].of_row[row], values[row]);
      }
    }
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (const std::optional<double> index = shares[p].Share(own_squares)) {
        resampled[p].push_back(*index);
      }
    }
  }
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (!indices[p] || resampled[p].size() < 2) {
      continue;
    }
    const double center = MeanOf(resampled[p]);
    double variance = 0.0;
    for (const double index : resampled[p]) {
      variance += (index - center) * (index - center);
    }
    const double half = z * std::sqrt(variance / static_cast<double>(resampled[p].size() - 1));
    indices[p]->interval = {indices[p]->index - half, indices[p]->index + half};
  }
  return indices;
}

namespace {

/// Returns the ranks of the values, counted from 0. Equal values get the mean of their ranks.
/// RanksOf returns nullopt if all values are equal.
std::optional<std::vector<double>> RanksOf(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) {
      ++end;
    }
    if (begin == 0 && end == order.size()) {
      return std::nullopt;
    }
    for (std::size_t i = begin; i < end; ++i) {
      ranks[order[i]] = 0.5 * static_cast<double>(begin + end - 1);
    }
    begin = end;
  }
  return ranks;
}

}  // namespace

std::optional<RankCorrelation> CorrelateRanks(const std::vector<double>& a,
                                              const std::vector<double>& b, double confidence) {
  TRACKBED_REQUIRE(a.size() == b.size(), "{} values against {}", a.size(), b.size());
  for (const auto* values : {&a, &b}) {
    TRACKBED_REQUIRE(
        std::all_of(values->begin(), values->end(), [](double v) { return std::isfinite(v); }),
        "a value is not finite");
  }
  const double z = NormalReach(confidence);
  constexpr std::size_t kMinSamples = 4;
  const auto ranks_a = RanksOf(a);
  const auto ranks_b = RanksOf(b);
  if (a.size() < kMinSamples || !ranks_a || !ranks_b) {
    return std::nullopt;
  }
  const double middle = 0.5 * static_cast<double>(a.size() - 1);
  double products = 0.0;
  double squares_a = 0.0;
  double squares_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = (*ranks_a)[i] - middle;
    const double y = (*ranks_b)[i] - middle;
    products += x * y;
    squares_a += x * x;
    squares_b += y * y;
  }
  const double rho = std::clamp(products / std::sqrt(squares_a * squares_b), -1.0, 1.0);
  const double half = z * std::sqrt((1.0 + 0.5 * rho * rho) / static_cast<double>(a.size() - 3));
  // Fisher transform of the rank correlation rho; infinite for rho = -1 and rho = 1.
  const double center = std::atanh(rho);
  return RankCorrelation{rho, {std::tanh(center - half), std::tanh(center + half)}};
}

PairedDifference ComparePairs(const std::vector<double>& a, const std::vector<double>& b,
                              double confidence) {
  TRACKBED_REQUIRE(a.size() == b.size() && !a.empty(), "{} values against {}", a.size(), b.size());
  std::vector<double> differences;
  PairedDifference pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences.push_back(b[i] - a[i]);
    ++(b[i] > a[i] ? pairs.higher : b[i] < a[i] ? pairs.lower : pairs.equal);
  }
  pairs.mean = EstimateMean(differences, confidence);
  pairs.median = Quantiles(std::move(differences), {0.5}).front();
  if (const std::size_t uneven = pairs.higher + pairs.lower; uneven > 0) {
    const boost::math::binomial_distribution<double, DoublePrecision> fair(
        static_cast<double>(uneven), 0.5);
    const auto fewer = static_cast<double>(std::min(pairs.higher, pairs.lower));
    pairs.sign_test = std::min(1.0, 2.0 * boost::math::cdf(fair, fewer));
  }
  return pairs;
}

}  // namespace trackbed
