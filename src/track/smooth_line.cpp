#include "src/track/smooth_line.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "src/track/track_fold.h"
#include "trackbed/core/angle.h"
#include "trackbed/path/bezier.h"

namespace trackbed {

SmoothLine::SmoothLine(const std::vector<TrackPoint>& points, std::optional<double> smoothing) {
  const std::size_t count = points.size();
  SplineSamples samples;
  samples.values.resize(static_cast<Eigen::Index>(count), 2);
  chords_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    chords_[i] = (points[(i + 1) % count].position - points[i].position).norm();
    samples.t.push_back(period_);
    samples.values.row(static_cast<Eigen::Index>(i)) = points[i].position.transpose();
    period_ += chords_[i];
  }
  // The weight of a point is half the length of the two chords that meet at the point.
  for (std::size_t i = 0; i < count; ++i) {
    samples.weights.push_back(0.5 * (chords_[(i + count - 1) % count] + chords_[i]));
  }
  parameters_ = samples.t;
  const double mean = period_ / static_cast<double>(count);
  smoothing_ = smoothing.value_or(kDefaultSmoothing * mean);
  constexpr double kMostKnots = 8.0;  // Largest factor by which a short wavelength adds knots.
  const double factor = std::clamp(kDefaultSmoothing * mean / smoothing_, 1.0, kMostKnots);
  // The small term keeps two knots per point if rounding makes the factor slightly larger than 1.
  const auto knots =
      static_cast<std::size_t>(std::ceil(2.0 * factor * static_cast<double>(count) - 1e-6));
  knot_distance_ = period_ / static_cast<double>(knots);
  basis_.emplace(period_, knots);
  coefficients_ = FitClosedSpline(*basis_, samples, smoothing_);
}

Vec2 SmoothLine::At(double t, std::size_t order) const {
  return Evaluate(basis_->At(t, order), coefficients_, order).transpose();
}

double SmoothLine::Length(double from, double to) const {
  return boost::math::quadrature::gauss<double, 7>::integrate(
      [&](double t) { return At(t, 1).norm(); }, from, to);
}

CurvePoint SmoothLine::PointAt(double t, double s, double yaw_before) const {
  const Vec2 tangent = At(t, 1);
  const double yaw = std::atan2(tangent.y(), tangent.x());
  return {.s = s,
          .yaw = yaw_before + AngleDifference(yaw, yaw_before),
          .curvature = CurvatureFromDerivatives(tangent, At(t, 2))};
}

}  // namespace trackbed
