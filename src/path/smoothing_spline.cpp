#include "src/path/smoothing_spline.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <unsupported/Eigen/Splines>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"

namespace trackbed {
namespace {

constexpr int kDegree = 5;
using Spline = Eigen::Spline<double, 2, Eigen::Dynamic>;

/// Returns the weight of each point, which is the length of the path that the point represents [m].
/// At the ends of an open path, a large factor multiplies the weight.
std::vector<double> Weights(const ChordPoints& fitted, double period) {
  const std::size_t count = fitted.u.size();
  std::vector<double> weights(count, 0.0);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double half = 0.5 * (fitted.u[i + 1] - fitted.u[i]);
    weights[i] += half;
    weights[i + 1] += half;
  }
  if (period > 0.0) {
    const double half = 0.5 * (fitted.u.front() + period - fitted.u.back());
    weights.front() += half;
    weights.back() += half;
  } else {
    // Weight the ends of an open path heavily, so that the path begins at its first point and ends
    // at its last point.
    constexpr double kEnds = 1e6;
    weights.front() *= kEnds;
    weights.back() *= kEnds;
  }
  return weights;
}

}  // namespace

SmoothingSpline::SmoothingSpline(const ChordPoints& fitted, double period,
                                 const EndHeadings& headings)
    : knots_(fitted.u), weights_(Weights(fitted, period)) {
  TRACKBED_CHECK(knots_.size() >= (period > 0.0 ? 3U : 2U), "{} points", knots_.size());
  const auto count = static_cast<Eigen::Index>(knots_.size());
  if (period > 0.0) {
    knots_.push_back(knots_.front() + period);
    size_ = count;
  } else {
    size_ = count + kDegree - 1;
  }
  all_knots_.resize(static_cast<Eigen::Index>(knots_.size()) + 2 * kDegree);
  for (Eigen::Index i = 0; i < all_knots_.size(); ++i) {
    const Eigen::Index own = i - kDegree;
    if (period > 0.0) {
      // Number of whole periods of the closed spline between the knot and its copy in the first
      // period.
      const Eigen::Index turns = (own + kDegree * count) / count - kDegree;
      all_knots_[i] = knots_[static_cast<std::size_t>(own - turns * count)] +
                      static_cast<double>(turns) * period;
    } else {
      all_knots_[i] = knots_[static_cast<std::size_t>(std::clamp<Eigen::Index>(own, 0, count - 1))];
    }
  }
  AddData(fitted, headings);
  AddPenalty();
}

SmoothingSpline::Basis SmoothingSpline::BasisAt(double u, int order) const {
  const Eigen::Index span = Spline::Span(u, kDegree, all_knots_);
  return {span - kDegree, Spline::BasisFunctionDerivatives(u, order, kDegree, all_knots_)};
}

void SmoothingSpline::AddData(const ChordPoints& fitted, const EndHeadings& headings) {
  std::vector<Eigen::Triplet<double>> entries;
  right_ = Eigen::MatrixX2d::Zero(size_, 2);
  // Adds a weighted equation for the spline's derivative of the given order at the chord length u.
  const auto add = [&](double u, int order, double weight, const Vec2& value) {
    const Basis basis = BasisAt(u, order);
    for (Eigen::Index a = 0; a <= kDegree; ++a) {
      const double factor = weight * basis.factors(order, a);
      right_.row(Coefficient(basis.first + a)) += factor * value.transpose();
      for (Eigen::Index b = 0; b <= kDegree; ++b) {
        entries.emplace_back(Coefficient(basis.first + a), Coefficient(basis.first + b),
                             factor * basis.factors(order, b));
      }
    }
  };
  for (std::size_t i = 0; i < fitted.u.size(); ++i) {
    add(fitted.u[i], 0, weights_[i], fitted.points[i]);
  }
  // The spline's derivative with respect to chord length is about a unit vector along the heading.
  // Multiply the weight of an end point by the squared knot distance, because the derivative has no
  // unit.
  const auto square = [](double length) { return length * length; };
  if (headings.begin) {
    add(knots_.front(), 1, weights_.front() * square(knots_[1] - knots_[0]),
        Direction(*headings.begin));
  }
  if (headings.end) {
    add(knots_.back(), 1, weights_.back() * square(knots_.back() - *(knots_.end() - 2)),
        Direction(*headings.end));
  }
  data_.resize(size_, size_);
  data_.setFromTriplets(entries.begin(), entries.end());
}

void SmoothingSpline::AddPenalty() {
  // The third derivative P''' is quadratic between knots, so a Gauss quadrature with three nodes
  // integrates the square of P''' exactly.
  const double node = std::sqrt(0.6);
  const std::array<std::pair<double, double>, 3> rule{
      {{-node, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {node, 5.0 / 9.0}}};
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double half = 0.5 * (knots_[i + 1] - knots_[i]);
    Eigen::Matrix<double, kDegree + 1, kDegree + 1> own;
    own.setZero();
    Eigen::Index first = 0;
    for (const auto& [place, weight] : rule) {
      const Basis basis = BasisAt(knots_[i] + half * (1.0 + place), 3);
      const Eigen::Matrix<double, kDegree + 1, 1> third = basis.factors.row(3).matrix().transpose();
      own += half * weight * third * third.transpose();
      first = basis.first;
    }
    for (Eigen::Index a = 0; a <= kDegree; ++a) {
      for (Eigen::Index b = 0; b <= kDegree; ++b) {
        entries.emplace_back(Coefficient(first + a), Coefficient(first + b), own(a, b));
      }
    }
  }
  penalty_.resize(size_, size_);
  penalty_.setFromTriplets(entries.begin(), entries.end());
}

bool SmoothingSpline::Fit(double smoothing_length) {
  const Matrix matrix = data_ + std::pow(smoothing_length, 6) * penalty_;
  if (!is_analyzed_) {
    solver_.analyzePattern(matrix);
    is_analyzed_ = true;
  }
  solver_.factorize(matrix);
  if (solver_.info() != Eigen::Success) {
    return false;
  }
  Eigen::MatrixX2d solution = solver_.solve(right_);
  if (!solution.allFinite()) {
    return false;
  }
  // Make one step of iterative refinement, which removes most of the solution's rounding error.
  solution += solver_.solve(Eigen::MatrixX2d(right_ - matrix * solution));
  if (!solution.allFinite()) {
    return false;
  }
  coefficients_ = std::move(solution);
  return true;
}

Vec2 SmoothingSpline::At(double u, int order) const {
  const Basis basis = BasisAt(u, order);
  Vec2 value(0.0, 0.0);
  for (Eigen::Index i = 0; i <= kDegree; ++i) {
    value += basis.factors(order, i) * coefficients_.row(Coefficient(basis.first + i)).transpose();
  }
  return value;
}

SampledSpline Sample(const SmoothingSpline& spline, double spacing, std::size_t max_points) {
  constexpr double kTurn = 0.2;     // Largest heading difference between adjacent samples [rad].
  constexpr int kMaxHalvings = 12;  // Limit for the number of halvings of the spacing.
  // Value of |P'| below which the spline has a cusp; usually, |P'| is about 1.
  constexpr double kMinDerivative = 1e-3;
  using Quadrature = boost::math::quadrature::gauss<double, 7>;
  const auto length = [&](double from, double to) {
    return Quadrature::integrate([&](double u) { return spline.At(u, 1).norm(); }, from, to);
  };
  SampledSpline sampled;
  const auto take = [&](double u, double s) {
    const Vec2 tangent = spline.At(u, 1);
    const double yaw = std::atan2(tangent.y(), tangent.x());
    const double before = sampled.points.empty() ? yaw : sampled.points.back().yaw;
    sampled.points.push_back({s, before + AngleDifference(yaw, before),
                              CurvatureFromDerivatives(tangent, spline.At(u, 2))});
    return tangent.norm() >= kMinDerivative;
  };
  const std::vector<double>& knots = spline.knots();
  if (!take(knots.front(), 0.0)) {
    return {};
  }
  sampled.knot_stations.push_back(0.0);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const std::size_t begin = sampled.points.size();
    auto pieces = static_cast<int>(std::ceil((knots[i + 1] - knots[i]) / spacing));
    bool is_fine = false;
    for (int halvings = 0; !is_fine && halvings <= kMaxHalvings; ++halvings, pieces *= 2) {
      if (begin + static_cast<std::size_t>(pieces) > max_points) {
        return {.points = {}, .knot_stations = {}, .is_too_long = true};
      }
      sampled.points.resize(begin);
      is_fine = true;
      double from = knots[i];
      for (int k = 1; is_fine && k <= pieces; ++k) {
        const double to = k == pieces
                              ? knots[i + 1]
                              : std::lerp(knots[i], knots[i + 1], k / static_cast<double>(pieces));
        const CurvePoint before = sampled.points.back();
        const double step = length(from, to);
        is_fine = step > 0.0 && take(to, before.s + step);
        const CurvePoint& after = sampled.points.back();
        is_fine =
            is_fine && std::abs(after.yaw - before.yaw) <= kTurn &&
            std::max(std::abs(after.curvature), std::abs(before.curvature)) * step <= 2.0 * kTurn;
        from = to;
      }
    }
    if (!is_fine) {
      return {};
    }
    sampled.knot_stations.push_back(sampled.points.back().s);
  }
  return sampled;
}

}  // namespace trackbed
