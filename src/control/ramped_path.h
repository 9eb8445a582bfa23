#pragma once

#include <vector>

#include "src/control/tracking.h"

namespace trackbed {

/// A path whose steps of the curvature are replaced by ramps that the wheels can follow.
///
/// At a step of the curvature, wheels with a limited rate lag behind the path. A control law that
/// tracks the path itself then saturates, and feeds back errors that it cannot avoid. A car with a
/// limited steering rate can drive the ramped path: a control law that tracks this path receives no
/// unavoidable errors, and commands rates within the limit.
///
/// The symbols are:
///   x       distance from the step along the path [m], positive behind the step
///   kappa   height of the step [1/m]
///   S       length of the ramp [m]: v abs(Delta delta)/omega, driven while the wheels turn
///   e       offset of the ramped path from the path [m], positive to the left
///   T       length of the tails [m]: 2 S
///
/// The curvature of the ramped path rises linearly at abs(x) < S/2. Such a ramp moves the path to
/// the side by kappa S^2/24. One part of this distance lies ahead of the ramp, where e < 0 for a
/// step to the left, and the other one behind it, where e > 0. Beyond the ramp, e returns to 0
/// within T, along a polynomial of degree 5. If the car can steer the tails on both sides, both
/// parts are equal. The curvature of the tails is then at most 0.03 kappa, and their steering rate
/// at most 0.16 omega. A turn at full lock leaves no steering for its tails, so the whole distance
/// lies on the side of less curvature. The effects of several steps are added.
///
/// A path without steps of the curvature is returned unchanged. The wheels turn at rest at cusps
/// and at the ends of the path, so steps there remain. S + T/2 is at most the distance from there,
/// so that the ramped path passes through cusps and ends.
class RampedPath {
 public:
  /// Finds the steps that act between the car's station and `ahead` [m] beyond it. The speed v at a
  /// step is SpeedAt. `input` must outlive the other calls. Takes heap memory only if the path has
  /// more segments than each before. Cost O(n) for a path of n segments.
  void Update(const ControlInput& input, double ahead);

  /// Takes the path of `input` as it is.
  void UpdateWithoutRamps(const ControlInput& input);

  /// Returns the ramped path's point beside station `s` of the path, which is between the stations
  /// of Update.
  [[nodiscard]] PathPoint At(double s) const;

  /// Returns the speed [m/s] at which the car passes station `s`: the planned one, plus the amount
  /// by which the car now exceeds its plan. Without a plan, it is the car's present speed.
  [[nodiscard]] double SpeedAt(double s) const;

  /// Returns the position of the car relative to the ramped path.
  [[nodiscard]] Tracking Track() const;

  /// Returns CurvatureAfterLag (tracking.h) of the ramped path [1/m].
  [[nodiscard]] double CurvatureAfterLag() const;

 private:
  struct Step {
    double station;
    double from;    // Curvature ahead of the step.
    double height;  // kappa
    double ramp;    // S
    double tail;    // T
    double before;  // Fraction of the offset that lies ahead of the step.
    int direction;
  };

  const ControlInput* input_ = nullptr;
  std::vector<Step> steps_;
};

}  // namespace trackbed
