#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "src/planning/racing/line_shape.h"
#include "trackbed/planning/racing/minimum_time.h"
#include "trackbed/track/closed_spline.h"

/// Model of laps along lines on a track, at stations that are evenly spaced along the track's
/// center line.
namespace trackbed {

/// Shape, speeds and time of a lap along one line.
struct Lap {
  std::vector<LineShape> shapes;  // Shape of the line at each station.
  std::vector<double> curvature;  // Curvature kappa of the line at each station [1/m].
  std::vector<double> stretch;  // Ratio dl/ds of line length to center line length at each station.
  std::vector<double> lengths;  // Length of the line between each station and the next [m].
  std::vector<double> speeds;   // Speed at each station [m/s].
  double time = 0.0;            // Lap time [s].
  double sharpest = 0.0;        // Largest |kappa| of the lap [1/m].
};

class LapModel {
 public:
  /// Makes a model with `count` stations.
  LapModel(const Track& track, const LapLimits& limits, std::size_t count);

  [[nodiscard]] const LapLimits& limits() const { return limits_; }
  [[nodiscard]] std::size_t count() const { return centers_.size(); }
  [[nodiscard]] double step() const { return step_; }  ///< distance between adjacent stations [m]
  [[nodiscard]] double StationAt(std::size_t i) const { return step_ * static_cast<double>(i); }
  [[nodiscard]] std::size_t After(std::size_t i) const { return i + 1 == count() ? 0 : i + 1; }
  [[nodiscard]] const PathPoint& center(std::size_t i) const { return centers_[i]; }

  /// Computes a lap along a line, driven at the limit. The line must not reach the center of
  /// curvature of the track's center line.
  [[nodiscard]] Lap Drive(const TrackLine& line) const;

  /// Returns the largest change of curvature between the stations i and i + 1 that the steering
  /// rate permits, multiplied by the speed [1/s]. Returns infinity if the steering rate is not
  /// limited.
  [[nodiscard]] double SteeringReach(const Lap& lap, std::size_t i) const;

 private:
  LapLimits limits_;
  double step_;
  std::vector<PathPoint> centers_;
};

}  // namespace trackbed
