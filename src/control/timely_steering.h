#pragma once

#include <functional>
#include <vector>

#include "src/control/ramped_path.h"

namespace trackbed {

/// Errors [m], [rad] that a car gains relative to its path, signed as in Tracking.
struct GainedErrors {
  double cross_track = 0.0;
  double heading = 0.0;
};

/// Limits the steering angle of a control law so that wheels with a limited rate can turn back in
/// time.
///
/// A law that feeds back errors assumes that the wheels follow at once. Wheels whose angle delta
/// differs from the steering angle delta_p(s) of the path return to delta_p(s) at most at their
/// rate omega. If the path itself turns the wheels at this rate, the difference remains until the
/// path's steering changes more slowly, and the heading error grows until then. The control law
/// then overshoots from side to side.
///
/// TimelySteering returns the solution of delta = law(E(delta)). E(delta) are the errors that the
/// car gains while its wheels turn from delta at the full rate, until the wheels reach delta_p(s):
///   d psi/ds = (tan(delta) - tan(delta_p))/L',   de/ds = psi,   d delta/dt = -+omega,
/// with L' the ratio of tan(delta) to the curvature in a steady turn [m]: the wheelbase L, and L +
/// K v^2 for a car with the understeer gradient K. The law adds E to the present errors. The law
/// thus follows the rule of time-optimal control: begin to turn back at the last moment from which
/// the full rate suffices (Athans and Falb 1966, ch. 7).
///
/// E(delta_p) is 0. Beside a path of constant curvature, E grows with the square of delta -
/// delta_p, so small errors are corrected as without TimelySteering. The solution lies between
/// delta_p and law(0). The solution does not depend on the present angle of the wheels.
class TimelySteering {
 public:
  /// Returns the steering angle [rad]. `untimely` is law(0) [rad]. `law` returns an angle within
  /// the steering limit for a car that has gained errors, and decreases if the errors to the left
  /// increase. `path` was updated for `input`, for the stations up to Horizon ahead. With `slip`,
  /// delta_p and L' are those of SteadyTurnOn, otherwise those of TurnWithoutSlip. The equation is
  /// solved to a relative 1e-12. Only the first call allocates heap memory. Cost: up to 160 points
  /// of the path, and about ten calls of `law`.
  double Steer(const ControlInput& input, const RampedPath& path, bool slip, double untimely,
               const std::function<double(const GainedErrors&)>& law);

  /// Returns the longest distance [m] over which Steer follows the path. The car drives this
  /// distance in four times the time in which the wheels turn from 0 to the steering limit.
  static double Horizon(const ControlInput& input);

 private:
  /// A step of the drive along the path. The curvature of the path is averaged over the step, so
  /// that a short flaw of the path does not move the wheels.
  struct Moment {
    double tangent = 0.0;  // tan(delta_p)
    double speed = 0.0;    // Signed speed [m/s].
    double length = 0.0;   // L' [m]
  };

  [[nodiscard]] GainedErrors GainedFrom(double steering) const;
  void Follow(const ControlInput& input, const RampedPath& path, bool slip, double most);

  std::vector<Moment> moments_;
  double step_ = 0.0;  // Duration of a step [s].
  double rate_ = 0.0;  // omega
};

}  // namespace trackbed
