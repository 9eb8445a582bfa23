#include "src/planning/curves/clothoid.h"

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace trackbed {
namespace {

/// Largest angle at which the power series are used [rad]; at 4 rad, their largest term is 10.
constexpr double kSeriesLimit = 4.0;

constexpr int kTerms = 14;  // the first omitted term of the series is below 1e-16 at kSeriesLimit

/// Coefficients of the power series in angle^2 of the two Fresnel integrals, the second one divided
/// by angle: (-1)^n/((2n)! (4n + 1)) and (-1)^n/((2n + 1)! (4n + 3)).
constexpr std::array<std::array<double, kTerms>, 2> Coefficients() {
  std::array<std::array<double, kTerms>, 2> c{};
  double factorial = 1.0;
  for (int n = 0; n < kTerms; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const auto i = static_cast<std::size_t>(n);
    c[0][i] = sign / (factorial * (4.0 * n + 1.0));
    factorial *= 2.0 * n + 1.0;
    c[1][i] = sign / (factorial * (4.0 * n + 3.0));
    factorial *= 2.0 * n + 2.0;
  }
  return c;
}

constexpr std::array<std::array<double, kTerms>, 2> kCoefficients = Coefficients();

/// Coefficients of the power series of ChordPerLength in angle^2. The coefficients are (-1)^n/(2n)!
/// times the integral of (1 - u^2)^(2n), which is the product of 2k/(2k + 1) for k from 1 to 2n.
constexpr std::array<double, kTerms> ChordCoefficients() {
  std::array<double, kTerms> c{};
  double term = 1.0;
  for (int n = 0; n < kTerms; ++n) {
    c[static_cast<std::size_t>(n)] = term;
    // In the quotient of two series terms, the factors 2n + 1 and 2n + 2 cancel.
    term *= -4.0 / ((4.0 * n + 3.0) * (4.0 * n + 5.0));
  }
  return c;
}

constexpr std::array<double, kTerms> kChordCoefficients = ChordCoefficients();

Vec2 Series(double angle) {
  const double square = angle * angle;
  double cos = 0.0;
  double sin = 0.0;
  for (std::size_t n = kTerms; n-- > 0;) {
    cos = cos * square + kCoefficients[0][n];
    sin = sin * square + kCoefficients[1][n];
  }
  return {cos, sin * angle};
}

/// Splits the sum into two chains of half the length, which the processor computes in parallel.
template <std::size_t terms>
double ChordSeries(double square) {
  const double fourth = square * square;
  double even = 0.0;
  double odd = 0.0;
  for (std::size_t n = terms; n > 0; n -= 2) {
    odd = odd * fourth + kChordCoefficients[n - 1];
    even = even * fourth + kChordCoefficients[n - 2];
  }
  return even + odd * square;
}

/// Integrates over pieces that turn by at most half a radian, as Path does.
Vec2 Quadrature(double angle) {
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  const double pieces = std::ceil(4.0 * std::abs(angle));
  Vec2 sum(0.0, 0.0);
  for (double i = 0.0; i < pieces; i += 1.0) {
    const double from = i / pieces;
    const double to = (i + 1.0) / pieces;
    sum.x() += Gauss::integrate([&](double u) { return std::cos(angle * u * u); }, from, to);
    sum.y() += Gauss::integrate([&](double u) { return std::sin(angle * u * u); }, from, to);
  }
  return sum;
}

}  // namespace

Vec2 FresnelPerLength(double angle) {
  return std::abs(angle) <= kSeriesLimit ? Series(angle) : Quadrature(angle);
}

double ChordPerLength(double angle) {
  constexpr double kShortSeriesLimit = 1.0;  // [rad]; the first omitted series term is below 1e-18.
  if (std::abs(angle) <= kShortSeriesLimit) {
    return ChordSeries<10>(angle * angle);
  }
  if (std::abs(angle) <= kSeriesLimit) {
    return ChordSeries<kTerms>(angle * angle);
  }
  return FresnelPerLength(angle).dot(Direction(angle));
}

}  // namespace trackbed
