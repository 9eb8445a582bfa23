#include "trackbed/planning/frenet/polynomial.h"

#include <tuple>

namespace trackbed {
namespace {

constexpr std::size_t kTerms = std::tuple_size_v<decltype(Polynomial::coefficients)>;

/// Returns i (i - 1) ... (i - order + 1), the factor of the coefficient of t^i in the derivative of
/// the given order.
using Factors = std::array<std::array<double, kTerms>, kTerms>;
constexpr Factors kFactors = [] {
  Factors factors{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    factors[0][i] = 1.0;
    for (std::size_t order = 1; order <= i; ++order) {
      factors[order][i] = factors[order - 1][i] * static_cast<double>(i - order + 1);
    }
  }
  return factors;
}();

}  // namespace

double Polynomial::At(double t, std::size_t order) const {
  const auto& factors = kFactors.at(order);
  double sum = 0.0;
  for (std::size_t i = kTerms; i-- > order;) {
    sum = sum * t + factors[i] * coefficients[i];
  }
  return sum;
}

double Polynomial::IntegralOfSquare(std::size_t order, double duration) const {
  const auto& factors = kFactors.at(order);
  // coefficients of the squared derivative, which is a polynomial
  std::array<double, 2 * kTerms> square{};
  for (std::size_t i = order; i < kTerms; ++i) {
    for (std::size_t j = order; j < kTerms; ++j) {
      square[i + j - 2 * order] += factors[i] * coefficients[i] * factors[j] * coefficients[j];
    }
  }
  double sum = 0.0;
  for (std::size_t power = 2 * (kTerms - order); power-- > 0;) {
    sum = sum * duration + square[power] / static_cast<double>(power + 1);
  }
  return sum * duration;
}

Polynomial QuinticBetween(const LineMotion& from, const LineMotion& to, double duration) {
  const double t = duration;
  // Differences between the target and the final state of a motion with constant acceleration,
  // scaled by powers of t.
  const double p = to.position - from.position - t * (from.velocity + 0.5 * t * from.acceleration);
  const double v = t * (to.velocity - from.velocity - t * from.acceleration);
  const double a = t * t * (to.acceleration - from.acceleration);
  const double cube = t * t * t;
  return {{from.position, from.velocity, 0.5 * from.acceleration,
           (10.0 * p - 4.0 * v + 0.5 * a) / cube, (-15.0 * p + 7.0 * v - a) / (cube * t),
           (6.0 * p - 3.0 * v + 0.5 * a) / (cube * t * t)}};
}

Polynomial QuarticBetween(const LineMotion& from, const LineMotion& to, double duration) {
  const double t = duration;
  const double v = to.velocity - from.velocity - t * from.acceleration;
  const double a = t * (to.acceleration - from.acceleration);
  return {{from.position, from.velocity, 0.5 * from.acceleration, (3.0 * v - a) / (3.0 * t * t),
           (a - 2.0 * v) / (4.0 * t * t * t), 0.0}};
}

}  // namespace trackbed
