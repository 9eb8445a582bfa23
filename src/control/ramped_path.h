#pragma once

#include <vector>

#include "src/control/tracking.h"

namespace trackbed {

/// A path whose curvature steps are replaced by curvature ramps that the wheels can follow.
///
/// At a step of the curvature, wheels with a limited steering rate lag behind the path. A control
/// law that tracks the original path saturates at a curvature step, and feeds back errors that no
/// command can avoid. A car with a limited steering rate can drive the ramped path. A control law
/// that tracks the ramped path sees no unavoidable errors, and commands steering rates within the
/// limit.
///
/// The symbols are:
///   x       distance from the step along the path [m], positive behind the step
///   kappa   height of the step [1/m]
///   S       length of the ramp [m]: v abs(Delta delta)/omega, driven while the wheels turn
///   e       offset of the ramped path from the path [m], positive to the left
///   T       length of a tail [m]: 2 S, or less before a cusp or path end
///
/// The curvature of the ramped path rises linearly over the ramp, where abs(x) < S/2. A ramp of
/// length S shifts the path sideways by kappa S^2/24. For a curvature step to the left, the offset
/// e is negative ahead of the ramp and positive behind the ramp. The difference of the offset e
/// across the ramp is the sideways shift. Beyond each end of the ramp, the offset e returns to 0
/// along a tail of length T, a polynomial of degree 5. If the car can steer the tails on both
/// sides, each side gets half of the sideways shift. The tails' curvature is then at most 0.03 of
/// the curvature step, and their steering rate at most 0.16 times the maximum. A turn at full lock
/// leaves no steering angle for a tail, so the whole sideways shift is on the other side of the
/// curvature step. The offsets that several curvature steps cause are added.
///
/// A path without steps of the curvature is returned unchanged. At cusps and at the ends of the
/// path, the wheels turn at rest, so curvature steps at these points remain. The tails of a
/// curvature step end before the nearest cusp or path end; the side with the shorter tail gets less
/// of the sideways shift. If a half of the ramp has no room before a cusp or path end, or no tail
/// has the length S, the ramp is shortened. The ramped path therefore passes through the cusps and
/// ends of the original path.
class RampedPath {
 public:
  /// Finds the curvature steps whose ramps or tails lie between the car's station and `ahead` [m]
  /// beyond it. The function SpeedAt gives the speed at a curvature step. The object `input` must
  /// exist during the calls of all other functions. Update allocates heap memory only if the path
  /// has more segments than all earlier paths. Update costs O(n) for a path of n segments.
  void Update(const ControlInput& input, double ahead);

  /// Uses the path of `input` without adding curvature ramps.
  void UpdateWithoutRamps(const ControlInput& input);

  /// Returns the ramped path's point beside station `s` of the original path. The range of the last
  /// Update must include `s`.
  [[nodiscard]] PathPoint At(double s) const;

  /// Returns the speed [m/s] at which the car passes station `s`: the planned speed, plus the
  /// amount by which the car now exceeds its planned speed. If no speed is planned, SpeedAt returns
  /// the car's present speed.
  [[nodiscard]] double SpeedAt(double s) const;

  /// Returns the position of the car relative to the ramped path.
  [[nodiscard]] Tracking Track() const;

  /// Returns the ramped path's curvature [1/m] at the distance `way` [m] ahead of the car, but not
  /// beyond a cusp.
  [[nodiscard]] double CurvatureAfter(double way) const;

 private:
  struct Step {
    double station;
    double from;         // Curvature before the curvature step.
    double height;       // Height kappa of the curvature step.
    double ramp;         // Ramp length S.
    double tail_before;  // Length T of the tail before the ramp.
    double tail_after;
    double before;  // Fraction of the sideways shift before the curvature step.
    int direction;
  };

  const ControlInput* input_ = nullptr;
  std::vector<Step> steps_;
};

}  // namespace trackbed
