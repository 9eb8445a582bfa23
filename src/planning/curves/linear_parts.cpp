#include "src/planning/curves/linear_parts.h"

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <complex>
#include <vector>

namespace trackbed {
namespace {

using Complex = std::complex<double>;

/// Points and weights of Gaussian quadrature over [0, 1].
struct GaussPoints {
  static constexpr std::size_t kPoints = 6;
  std::array<double, kPoints> at{};
  std::array<double, kPoints> weight{};

  GaussPoints() {
    using Gauss = boost::math::quadrature::gauss<double, kPoints>;
    for (std::size_t i = 0; i < kPoints / 2; ++i) {
      at[2 * i] = 0.5 - 0.5 * Gauss::abscissa()[i];
      at[2 * i + 1] = 0.5 + 0.5 * Gauss::abscissa()[i];
      weight[2 * i] = weight[2 * i + 1] = 0.5 * Gauss::weights()[i];
    }
  }
};

/// A piece, with the displacement from its start to its end and its derivatives.
struct Displacement {
  Complex total;
  Complex by_length;
  Complex by_first;
  Complex by_last;
};

Displacement DisplacementOf(double length, double first, double last, double yaw) {
  static const GaussPoints points;
  Complex sum;
  Complex turned;
  Complex by_first;
  Complex by_last;
  for (std::size_t k = 0; k < GaussPoints::kPoints; ++k) {
    const double u = points.at[k];
    const double turn = first * u + 0.5 * (last - first) * u * u;  // per length
    const Complex way = points.weight[k] * std::polar(1.0, yaw + length * turn);
    sum += way;
    turned += turn * way;
    by_first += (u - 0.5 * u * u) * way;
    by_last += 0.5 * u * u * way;
  }
  constexpr Complex kLeft(0.0, 1.0);
  return {length * sum, sum + length * kLeft * turned, length * length * kLeft * by_first,
          length * length * kLeft * by_last};
}

}  // namespace

PartsEnd EndOf(const LinearParts& parts) {
  const Eigen::Index n = parts.lengths.size();
  std::vector<Displacement> moves;
  std::vector<Complex> ends;
  Complex at;
  double yaw = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double first = parts.curvatures[i];
    const double last = parts.curvatures[i + 1];
    moves.push_back(DisplacementOf(parts.lengths[i], first, last, yaw));
    at += moves.back().total;
    ends.push_back(at);
    yaw += 0.5 * parts.lengths[i] * (first + last);
  }
  PartsEnd found{.end = {at.real(), at.imag(), yaw},
                 .rows = SmoothValues::Rows::Zero(3, 2 * n + 1)};
  constexpr Complex kLeft(0.0, 1.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double half = 0.5 * parts.lengths[i];
    const double mean = 0.5 * (parts.curvatures[i] + parts.curvatures[i + 1]);
    const Complex by_yaw = kLeft * (at - ends[k]);
    const auto add = [&](Eigen::Index variable, const Complex& moved, double turned) {
      const Complex total = moved + turned * by_yaw;
      found.rows.col(variable) += Eigen::Vector3d(total.real(), total.imag(), turned);
    };
    add(i, moves[k].by_first, half);
    add(i + 1, moves[k].by_last, half);
    add(n + 1 + i, moves[k].by_length, mean);
  }
  return found;
}

}  // namespace trackbed
