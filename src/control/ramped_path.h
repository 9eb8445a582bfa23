#pragma once

#include <vector>

#include "src/control/tracking.h"

namespace trackbed {

/// A path whose steps of the curvature are replaced by ramps that the wheels can follow.
///
/// At a step of the curvature, wheels with a limited rate lag behind the path. A control law that
/// tracks the path itself saturates at the step, and feeds back errors that no command can avoid. A
/// car with a limited steering rate can drive the ramped path. A control law that tracks the ramped
/// path receives no unavoidable errors, and commands rates within the limit.
///
/// The symbols are:
///   x       distance from the step along the path [m], positive behind the step
///   kappa   height of the step [1/m]
///   S       length of the ramp [m]: v abs(Delta delta)/omega, driven while the wheels turn
///   e       offset of the ramped path from the path [m], positive to the left
///   T       length of the tails [m]: 2 S
///
/// The curvature of the ramped path rises linearly over the ramp, where abs(x) < S/2. A ramp of
/// length S shifts the path sideways by kappa S^2/24. For a curvature step to the left, the offset
/// e is negative ahead of the ramp and positive behind the ramp. The difference of the offset e
/// across the ramp is the sideways shift. Beyond each end of the ramp, the offset e returns to 0
/// along a tail of length T, a polynomial of degree 5. If the car can steer the tails on both
/// sides, each side gets half of the sideways shift. The curvature of the tails is then at most
/// 0.03 kappa, and their steering rate is at most 0.16 times the maximum omega. A turn at full lock
/// leaves no steering angle for a tail, so the whole sideways shift lies on the other side of the
/// step. The offsets of several curvature steps are added.
///
/// A path without steps of the curvature is returned unchanged. At cusps and at the ends of the
/// path, the wheels turn at rest, so curvature steps at these points remain. The length S/2 + T of
/// half a ramp and a tail is at most the distance of the step from the nearest cusp or end. The
/// ramped path therefore passes through cusps and ends.
class RampedPath {
 public:
  /// Finds the curvature steps whose ramps or tails lie between the car's station and `ahead` [m]
  /// beyond it. SpeedAt returns the speed v at a step. `input` must outlive the calls of all other
  /// functions. Allocates heap memory only if the path has more segments than all earlier paths.
  /// Cost O(n) for a path of n segments.
  void Update(const ControlInput& input, double ahead);

  /// Uses the path of `input` as it is, without ramps.
  void UpdateWithoutRamps(const ControlInput& input);

  /// Returns the ramped path's point beside station `s` of the path. The last call of Update must
  /// have covered `s`.
  [[nodiscard]] PathPoint At(double s) const;

  /// Returns the speed [m/s] at which the car passes station `s`: the planned speed, plus the
  /// amount by which the car now exceeds its planned speed. Without a planned speed, returns the
  /// car's present speed.
  [[nodiscard]] double SpeedAt(double s) const;

  /// Returns the position of the car relative to the ramped path.
  [[nodiscard]] Tracking Track() const;

  /// Returns CurvatureAfterLag (tracking.h) of the ramped path [1/m].
  [[nodiscard]] double CurvatureAfterLag() const;

 private:
  struct Step {
    double station;
    double from;    // Curvature ahead of the step.
    double height;  // Height kappa of the step.
    double ramp;    // Ramp length S.
    double tail;    // Tail length T.
    double before;  // Fraction of the offset that lies ahead of the step.
    int direction;
  };

  const ControlInput* input_ = nullptr;
  std::vector<Step> steps_;
};

}  // namespace trackbed
