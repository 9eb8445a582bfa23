#pragma once

#include <functional>
#include <vector>

#include "src/control/ramped_path.h"

namespace trackbed {

/// Cross-track error [m] and heading error [rad] that a car gains relative to its path, signed as
/// in Tracking.
struct GainedErrors {
  double cross_track = 0.0;
  double heading = 0.0;
};

/// Limits the steering angle of a control law so that wheels with a limited rate can turn back in
/// time.
///
/// A control law that feeds back errors assumes that the wheels follow the command at once. Wheels
/// whose angle delta differs from the steering angle delta_p(s) of the path return to delta_p(s) at
/// most at their rate omega. If the path itself requires the full rate, the wheels cannot return,
/// and the heading error grows, until the path's steering angle changes more slowly. The control
/// law then overshoots from side to side.
///
/// TimelySteering returns the solution of delta = law(E(delta)). E(delta) are the errors that the
/// car gains while its wheels turn from delta to delta_p(s) at the full rate. The differential
/// equations of these errors are:
///   d psi/ds = (tan(delta) - tan(delta_p))/L',   de/ds = psi,   d delta/dt = -+omega.
/// The length L' [m] is the ratio of tan(delta) to the curvature in a steady turn. L' equals the
/// wheelbase L, or L + K v^2 for a car with the understeer gradient K. The control law adds the
/// gained errors E to the present errors. TimelySteering thus follows the rule of time-optimal
/// control: begin to turn back at the last moment from which the full rate suffices (Athans and
/// Falb 1966, ch. 7).
///
/// The gained errors E(delta_p) are 0. Beside a path of constant curvature, E grows with the square
/// of delta - delta_p, so small errors are corrected as without TimelySteering. The solution delta
/// lies between delta_p, the angle of the path, and law(0), the angle of the unlimited law. The
/// solution does not depend on the present angle of the wheels.
class TimelySteering {
 public:
  /// Returns the steering angle [rad]. The argument `untimely` is law(0) [rad]. The function `law`
  /// must return an angle within the steering limit for a car that has gained errors. The angle
  /// that `law` returns must decrease if the errors to the left increase. The ramped path `path`
  /// must have been updated for `input`, for the stations up to Horizon ahead. If `slip` is set,
  /// delta_p and L' come from SteadyTurnOn, otherwise from TurnWithoutSlip. The steering angle has
  /// a relative precision of 1e-12. Only the first call allocates heap memory. Each call of Steer
  /// evaluates up to 160 points of the path, and calls `law` about ten times.
  double Steer(const ControlInput& input, const RampedPath& path, bool slip, double untimely,
               const std::function<double(const GainedErrors&)>& law);

  /// Returns the longest distance [m] over which Steer follows the path. The car drives this
  /// distance in four times the time in which the wheels turn from 0 to the steering limit.
  static double Horizon(const ControlInput& input);

 private:
  /// A time step of the predicted drive along the path. The curvature of the path is averaged over
  /// the step, so that a short flaw of the path does not move the wheels.
  struct Moment {
    double tangent = 0.0;  // Tangent of the path's steering angle, tan(delta_p).
    double speed = 0.0;    // Signed speed [m/s].
    double length = 0.0;   // Ratio L' [m].
  };

  [[nodiscard]] GainedErrors GainedFrom(double steering) const;
  void Follow(const ControlInput& input, const RampedPath& path, bool slip, double most);

  std::vector<Moment> moments_;
  double step_ = 0.0;  // Duration of a step [s].
  double rate_ = 0.0;  // Steering rate omega [rad/s].
};

}  // namespace trackbed
