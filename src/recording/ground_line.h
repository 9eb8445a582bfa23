#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/track/closed_spline.h"
#include "trackbed/track/track.h"

// The center line of a banked road, which is closed or open.
namespace trackbed {

/// A smoothing spline through samples of an open curve.
///
/// The open spline is computed as a closed spline (closed_spline.h). The straight line from the
/// first to the last sample is subtracted from the samples. The remainder is continued as an odd
/// function beyond both ends, which makes it periodic. Due to the odd continuation, the curve
/// passes through its first and last sample with zero second derivative. Beyond its ends, the curve
/// continues straight.
class OpenSpline {
 public:
  /// `t` contains the parameters of the samples in increasing order, beginning with 0. Each row of
  /// `values` is a sample.
  OpenSpline(const std::vector<double>& t, const Eigen::MatrixXd& values, double wavelength);

  /// Returns the derivative of the curve with the order `order`, 0 to 2, at any parameter; order 0
  /// is the curve itself.
  [[nodiscard]] Eigen::RowVectorXd At(double t, std::size_t order) const;

 private:
  double length_;
  Eigen::RowVectorXd start_;
  Eigen::RowVectorXd slope_;
  ClosedSplineBasis basis_;
  Eigen::MatrixXd coefficients_;
};

/// Bank and height along a center line.
class GroundSurface {
 public:
  GroundSurface(std::vector<double> stations, double length, bool closed, double wavelength,
                const Eigen::MatrixXd& values);

  /// Returns the smoothed row of `values` at a station, such as bank and height.
  [[nodiscard]] Eigen::RowVectorXd At(double s) const;

 private:
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
  std::optional<OpenSpline> open_;
};

class GroundLine {
 public:
  /// An open line needs Track::kMinPoints or more points that do not repeat.
  GroundLine(std::vector<TrackPoint> points, bool closed);

  [[nodiscard]] const std::vector<TrackPoint>& points() const { return points_; }
  [[nodiscard]] bool closed() const { return track_.has_value(); }
  [[nodiscard]] double length() const { return length_; }
  /// Returns the station of a point. On an open line, the station of a point is the length of the
  /// chords up to the point.
  [[nodiscard]] double StationOf(std::size_t point) const;
  /// Returns the point at any station. A closed line repeats; an open line continues straight.
  [[nodiscard]] PathPoint At(double s) const;
  [[nodiscard]] TrackEdges EdgesAt(double s) const;
  /// Returns the distance of a station beyond the ends of an open line [m]; 0 for stations on the
  /// line and for closed lines.
  [[nodiscard]] double BeyondEnds(double s) const;
  /// Returns a smooth surface with the given values at the points: one row for each point.
  [[nodiscard]] GroundSurface SurfaceThrough(const Eigen::MatrixXd& values) const;

 private:
  std::vector<TrackPoint> points_;
  std::optional<Track> track_;
  std::vector<double> stations_;
  std::optional<OpenSpline> open_;
  double length_ = 0.0;
};

}  // namespace trackbed
