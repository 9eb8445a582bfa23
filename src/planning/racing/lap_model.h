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
  [[nodiscard]] double fastest() const { return fastest_; }  ///< largest speed of a lap [m/s]
  [[nodiscard]] std::size_t count() const { return centers_.size(); }
  [[nodiscard]] double step() const { return step_; }  ///< distance between adjacent stations [m]
  [[nodiscard]] double StationAt(std::size_t i) const { return step_ * static_cast<double>(i); }
  [[nodiscard]] std::size_t After(std::size_t i) const { return i + 1 == count() ? 0 : i + 1; }
  [[nodiscard]] const PathPoint& center(std::size_t i) const { return centers_[i]; }

  /// Computes a lap along a line, driven at the limit. The line must not reach the center of
  /// curvature of the track's center line.
  [[nodiscard]] Lap Drive(const TrackLine& line) const;

  /// Steering between the stations i and i + 1 at the same speed at both stations.
  struct Turn {
    /// Mean steering rate, as a fraction of the rate that the lap may use, with the sign of the
    /// change of the steering angle.
    double ratio = 0.0;
    double by_from = 0.0;   ///< Derivative of steering-rate ratio by kappa at station i [m].
    double by_to = 0.0;     ///< Derivative of steering-rate ratio by kappa at station i + 1 [m].
    double by_speed = 0.0;  ///< Derivative of the steering-rate ratio by the speed [s/m].
  };
  /// Computes the steering between the stations i and i + 1 of a lap at the given speed [m/s], on
  /// the tyres of the car. Returns zeros if the steering rate is not limited.
  [[nodiscard]] Turn TurnAt(const Lap& lap, std::size_t i, double speed) const;

 private:
  /// Returns the steering rate that a lap may use [rad/s]; 0: no limit.
  [[nodiscard]] double UsableRate() const;
  /// Returns the steering angle of the car at a station of the lap, at the given speed [rad].
  [[nodiscard]] double SteeringAt(double curvature, double speed) const;
  /// Returns the highest speed at which the steering-rate ratio of TurnAt has at most the magnitude
  /// 1. Returns the top speed fastest() if the steering rate limits no speed within the lateral
  /// grip.
  [[nodiscard]] double SpeedOfTurn(const Lap& lap, std::size_t i) const;

  LapLimits limits_;
  double fastest_;
  double lateral_;  // largest lateral force at any speed [m/s^2]
  double step_;
  std::vector<PathPoint> centers_;
};

}  // namespace trackbed
