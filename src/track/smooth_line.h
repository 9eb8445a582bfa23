#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/track/closed_spline.h"
#include "trackbed/track/track.h"

namespace trackbed {

/// The smoothed center line of a track as a function of a parameter t [m], the length of the closed
/// polyline through the points.
class SmoothLine {
 public:
  /// Fits the line; without `smoothing`, the wavelength is kDefaultSmoothing times the mean
  /// distance of the points.
  SmoothLine(const std::vector<TrackPoint>& points, std::optional<double> smoothing);

  /// Wavelength of the smoothing [m].
  [[nodiscard]] double smoothing() const { return smoothing_; }
  /// Length of the closed polyline [m].
  [[nodiscard]] double period() const { return period_; }
  /// Distance between the knots of the spline [m]: an eighth of the wavelength, so the knots
  /// resolve the wavelength. Bounded by half and a sixteenth of the mean distance of the points.
  [[nodiscard]] double knot_distance() const { return knot_distance_; }
  /// Parameter of each point [m].
  [[nodiscard]] const std::vector<double>& parameters() const { return parameters_; }
  /// Distance from each point to the next point [m].
  [[nodiscard]] const std::vector<double>& chords() const { return chords_; }

  [[nodiscard]] Vec2 At(double t, std::size_t order) const;
  [[nodiscard]] double Length(double from, double to) const;
  /// Returns the point of the line at parameter t, with the given station `s`. The yaw of the point
  /// continues the yaw of the previous point without jumps of whole turns.
  [[nodiscard]] CurvePoint PointAt(double t, double s, double yaw_before) const;

 private:
  double smoothing_ = 0.0;
  double period_ = 0.0;
  double knot_distance_ = 0.0;
  std::vector<double> parameters_;
  std::vector<double> chords_;
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
};

}  // namespace trackbed
