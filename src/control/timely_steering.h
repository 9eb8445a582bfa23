#pragma once

#include <functional>
#include <vector>

#include "src/control/ramped_path.h"

namespace trackbed {

/// Changes of the cross-track error [m] and heading error [rad] of a car while its wheels turn
/// back, signed as in Tracking.
struct GainedErrors {
  double cross_track = 0.0;
  double heading = 0.0;
};

/// Limits the steering angle of a control law so that wheels with a limited rate can turn back in
/// time.
///
/// A feedback control law assumes that the wheels follow the command at once. Wheels whose angle
/// delta differs from the steering angle delta_p(s) of the path return to delta_p(s) at most at
/// their rate omega. If the path requires the full steering rate, the wheels cannot return to
/// delta_p, and the heading error grows until the path's steering angle changes more slowly. A
/// control law that ignores the steering rate then overshoots its path from side to side.
///
/// TimelySteering returns the steering angle delta that solves delta = law(E(delta)). E(delta) are
/// the path errors that the car gains while its wheels turn from delta to delta_p(s) at the full
/// rate. The gained heading error psi and cross-track error e have the differential equations:
///   d psi/ds = (tan(delta) - tan(delta_p))/L',   de/ds = psi,   d delta/dt = -+omega.
/// The length L' [m] is the ratio of tan(delta) to the curvature in a steady turn. L' equals the
/// wheelbase L, or L + K v^2 for a car with the understeer gradient K. The control law adds the
/// gained errors E to the present errors. TimelySteering follows the rule of time-optimal control:
/// begin to turn back at the last moment from which the full rate suffices (Athans and Falb 1966,
/// ch. 7).
///
/// Wheels and tyres respond to a command with a delay. The prediction therefore begins at the
/// station that the car reaches after this delay (ResponseDistance). Wheels that turn back one
/// delay too late stay behind a path that turns at the full rate, and gain errors until its end.
///
/// The gained errors E(delta_p) are 0. On a path of constant curvature, the gained errors E grow
/// with (delta - delta_p)^2, so TimelySteering hardly changes small steering corrections. The
/// solution delta lies between delta_p, the angle of the path, and law(0), the angle of the
/// unlimited law. The solution does not depend on the present angle of the wheels.
class TimelySteering {
 public:
  /// Returns the steering angle [rad] with which the wheels can turn back in time. The argument
  /// `untimely` is the angle law(0) [rad] of the unlimited control law. The function `law` must
  /// return an angle within the steering limit for a car that has gained errors. The angle that
  /// `law` returns must decrease if the errors to the left increase. The ramped path `path` must
  /// have been updated for `input`, for the stations up to Horizon ahead. If `slip` is set, the
  /// path's steering angle delta_p and the length L' account for tyre slip (SteadyTurnOn). Without
  /// `slip`, delta_p and L' come from TurnWithoutSlip. The steering angle has a relative precision
  /// of 1e-12. Only the first call allocates heap memory. Each call of Steer evaluates up to 160
  /// points of the path, and calls `law` about ten times.
  double Steer(const ControlInput& input, const RampedPath& path, bool slip, double untimely,
               const std::function<double(const GainedErrors&)>& law);

  /// Returns the longest distance [m] along the path that Steer predicts. The car drives this
  /// distance in its delay and four times the time in which the wheels turn from 0 to the steering
  /// limit.
  static double Horizon(const ControlInput& input);

 private:
  /// A time step of the predicted drive along the path. The curvature of the path is averaged over
  /// the step, so that a short flaw of the path does not move the wheels.
  struct Moment {
    double tangent = 0.0;  // Tangent of the path's steering angle, tan(delta_p).
    double speed = 0.0;    // Signed speed [m/s].
    double length = 0.0;   // Ratio L' of tan(delta) to curvature [m].
  };

  [[nodiscard]] GainedErrors GainedFrom(double steering) const;
  void Follow(const ControlInput& input, const RampedPath& path, bool slip, double most);

  std::vector<Moment> moments_;
  double step_ = 0.0;  // Duration of a time step [s].
  double rate_ = 0.0;  // Steering rate omega [rad/s].
};

}  // namespace trackbed
