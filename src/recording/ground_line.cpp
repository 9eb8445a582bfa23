#include "src/recording/ground_line.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"

namespace trackbed {
namespace {

// Wavelength of the smoothing as a multiple of the mean distance of the points; the default of a
// Track has the same value.
constexpr double kSmoothing = 4.0;

std::vector<double> ChordStations(const std::vector<TrackPoint>& points) {
  std::vector<double> stations{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    stations.push_back(stations.back() + (points[i].position - points[i - 1].position).norm());
  }
  return stations;
}

Eigen::MatrixXd PositionsOf(const std::vector<TrackPoint>& points) {
  Eigen::MatrixXd positions(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    positions.row(static_cast<Eigen::Index>(i)) = points[i].position.transpose();
  }
  return positions;
}

std::size_t CountFunctions(std::size_t samples) {
  return std::max(ClosedSplineBasis::kMinFunctions, 4 * (samples - 1));
}

}  // namespace

OpenSpline::OpenSpline(const std::vector<double>& t, const Eigen::MatrixXd& values,
                       double wavelength)
    : length_(t.back()),
      start_(values.row(0)),
      slope_((values.row(values.rows() - 1) - values.row(0)) / t.back()),
      basis_(2.0 * t.back(), CountFunctions(t.size())) {
  const std::size_t last = t.size() - 1;
  SplineSamples samples;
  samples.values.resize(static_cast<Eigen::Index>(2 * last), values.cols());
  const auto add = [&](double at, double weight, const Eigen::RowVectorXd& value) {
    samples.values.row(static_cast<Eigen::Index>(samples.t.size())) = value;
    samples.t.push_back(at);
    samples.weights.push_back(weight);
  };
  const auto bent = [&](std::size_t i) -> Eigen::RowVectorXd {
    return values.row(static_cast<Eigen::Index>(i)) - start_ - t[i] * slope_;
  };
  const auto weight = [&](std::size_t i) {
    const double before = i > 0 ? t[i] - t[i - 1] : t[1];
    const double after = i < last ? t[i + 1] - t[i] : t[last] - t[last - 1];
    return 0.5 * (before + after);
  };
  for (std::size_t i = 0; i <= last; ++i) {
    add(t[i], weight(i), bent(i));
  }
  for (std::size_t i = last - 1; i > 0; --i) {
    add(2.0 * length_ - t[i], weight(i), -bent(i));
  }
  coefficients_ = FitClosedSpline(basis_, samples, wavelength);
}

Eigen::RowVectorXd OpenSpline::At(double t, std::size_t order) const {
  const double inside = std::clamp(t, 0.0, length_);
  const auto bent = [&](std::size_t own) {
    return Evaluate(basis_.At(inside, own), coefficients_, own);
  };
  const Eigen::RowVectorXd slope = slope_ + bent(1);
  if (order == 0) {
    return start_ + inside * slope_ + bent(0) + (t - inside) * slope;
  }
  return order == 1 ? slope : t == inside ? bent(2) : Eigen::RowVectorXd(0.0 * slope);
}

GroundSurface::GroundSurface(std::vector<double> stations, double length, bool closed,
                             double wavelength, const Eigen::MatrixXd& values) {
  if (!closed) {
    open_.emplace(stations, values, wavelength);
    return;
  }
  SplineSamples samples;
  const std::size_t count = stations.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double before = i == 0 ? stations.back() - length : stations[i - 1];
    const double after = i + 1 == count ? length : stations[i + 1];
    samples.weights.push_back(0.5 * (after - before));
  }
  samples.t = std::move(stations);
  samples.values = values;
  basis_.emplace(length, count);
  coefficients_ = FitClosedSpline(*basis_, samples, wavelength);
}

Eigen::RowVectorXd GroundSurface::At(double s) const {
  return open_ ? open_->At(s, 0) : Evaluate(basis_->At(s, 0), coefficients_, 0);
}

GroundLine::GroundLine(std::vector<TrackPoint> points, bool closed) : points_(std::move(points)) {
  if (closed) {
    track_.emplace(points_);
    length_ = track_->length();
    return;
  }
  TRACKBED_REQUIRE(points_.size() >= Track::kMinPoints, "GroundLine: {} points; must be {} or more",
                   points_.size(), Track::kMinPoints);
  stations_ = ChordStations(points_);
  length_ = stations_.back();
  open_.emplace(stations_, PositionsOf(points_),
                kSmoothing * length_ / static_cast<double>(points_.size() - 1));
}

double GroundLine::StationOf(std::size_t point) const {
  return track_ ? track_->StationOf(point) : stations_[point];
}

PathPoint GroundLine::At(double s) const {
  if (track_) {
    return track_->At(s);
  }
  const Vec2 position = open_->At(s, 0).transpose();
  const Vec2 tangent = open_->At(s, 1).transpose();
  PathPoint point;
  point.pose = {position.x(), position.y(), std::atan2(tangent.y(), tangent.x())};
  point.curvature = CurvatureFromDerivatives(tangent, Vec2(open_->At(s, 2).transpose()));
  return point;
}

TrackEdges GroundLine::EdgesAt(double s) const {
  if (track_) {
    return track_->EdgesAt(s);
  }
  const auto after = std::upper_bound(stations_.begin() + 1, stations_.end() - 1, s);
  const auto i = static_cast<std::size_t>(std::distance(stations_.begin(), after));
  const double share =
      std::clamp((s - stations_[i - 1]) / (stations_[i] - stations_[i - 1]), 0.0, 1.0);
  return {.left = std::lerp(points_[i - 1].width_left, points_[i].width_left, share),
          .right = -std::lerp(points_[i - 1].width_right, points_[i].width_right, share)};
}

double GroundLine::BeyondEnds(double s) const {
  return track_ ? 0.0 : std::max({0.0, -s, s - length_});
}

GroundSurface GroundLine::SurfaceThrough(const Eigen::MatrixXd& values) const {
  std::vector<double> stations;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    stations.push_back(StationOf(i));
  }
  const double wavelength =
      track_ ? track_->smoothing() : kSmoothing * length_ / static_cast<double>(points_.size() - 1);
  return {std::move(stations), length_, closed(), wavelength, values};
}

}  // namespace trackbed
