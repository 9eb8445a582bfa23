#pragma once

#include "trackbed/control/steering_controller.h"

/// Default preview distance R [m] of controllers that steer toward a point of the path. The
/// controller `preview` steers toward a point of RampedPath, which has no curvature steps, and uses
/// only the terms 3/4 L and 3 v T of the preview distance R (L: wheelbase, T: response time).
///
/// The symbols are:
///   L      wheelbase [m]
///   v      speed [m/s]
///   omega  steering rate at the road wheels [rad/s]
///   T      response time [s]
///   delta(s) = atan(L kappa(s))  steering angle of the path at station s [rad]
///   S      ramp length [m]: distance that the car drives while its wheels lag behind the path
///
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T = control period + steering lag + m v/(C_f + C_r)
///   S = max over s_1 < s_2 of  v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1),
///       both stations within R of the car
///
/// Reason for the term 3/4 L: pure pursuit responds to an offset e with the steering angle 2 L
/// e/R^2, and to a heading error psi with 2 L psi/R. A car that enters a circle of radius r cuts
/// the corner by R^2/(8 r). With R = 3/4 L and a steering angle of 26 degrees, the car cuts the
/// corner by 3.5 % of L.
///
/// Reason for the term 3 v T: consider a kinematic car with a first-order steering lag T that
/// follows a straight path. The car's characteristic polynomial is T s^3 + s^2 + (2 v/R) s + 2
/// v^2/R^2. The car's motion is stable for preview distances R > v T (Routh). The motion's damping
/// ratio is 0.37 at R = 3 v T and 1/2 at R = 4 v T. Heredia and Ollero 2007 treat a pure steering
/// delay instead of a lag. Preview distances proportional to the speed are common (Snider 2009).
/// The tyres' lateral response has the time constant m v/(C_f + C_r), with the cornering
/// stiffnesses.
///
/// Reason for the term 0.65 S + v T: at a step of the path's curvature, wheels with a limited
/// steering rate need the ramp length S to turn. Ideally, half of the ramp length S lies before the
/// curvature step, and half behind the step. With a preview distance below half of the ramp length
/// S, the wheels begin to turn too late, and the car swings out. In the term 0.65 S of the preview
/// distance, the factor 0.65 instead of 1/2 leaves a margin for model errors. With the preview
/// distance 0.65 S + v T, a car deviates by about kappa S^2/24 at a curvature step of size kappa.
/// Kappa S^2/24 is also the lateral distance between a path with a curvature ramp of length S and a
/// path with the step. The ramp length S is 0 if the wheels can follow the path's curvature.
namespace trackbed {

/// Lower bound for speeds that are used as divisors [m/s].
inline constexpr double kCrawl = 0.5;

/// Cross-track error, as a fraction of the wheelbase, for which the default look-ahead distances
/// are designed.
inline constexpr double kReturnOffset = 0.125;

/// Returns the response time T [s] of a car at `speed` with the control period `period`. The time
/// constant m v/(C_f + C_r) of the tyres is 0 for a car without tyre coefficients.
double ResponseTime(const VehicleParams& vehicle, double speed, double period);

/// Returns the time T_t [s] by which the front wheels of a car on tyres must lead the curvature of
/// its path, at a constant `speed`; 0 for a car without tyre coefficients. If the curvature kappa
/// of the path of the rear axle changes at a constant rate, the linear single-track car needs
///   tan(delta) = (L + K v^2) (kappa + T_t dkappa/dt)
///   T_t = v ((m l_r^2 + I)/C_f + (I - m l_r l_f)/C_r + m l_f L/C_r)/(L (L + K v^2))
/// with the understeer gradient K, the yaw inertia I, and the distances l_f and l_r of the axles
/// from the center of gravity. For equal axles and I = m L^2/4, T_t is twice the time constant m
/// v/(C_f + C_r). A negative K counts as 0.
double TyreDelay(const VehicleParams& vehicle, double speed);

/// Returns the distance [m] that the car drives within one control period, the delay of its
/// steering and TyreDelay. A control law that commands the path's curvature from this distance
/// ahead turns the car in time.
double ResponseDistance(const ControlInput& input);

/// Returns the default preview distance R [m] on a straight path: max(3/4 L, 3 v T), with the
/// wheelbase L, the speed v and the response time T. The argument `delay` [s] is added to the
/// response time T.
double ShortestPreview(const VehicleParams& vehicle, double speed, double period,
                       double delay = 0.0);

/// Returns the preview distance R [m] for the car's present state, with `delay` [s] added to the
/// response time. Samples the path's steering at stations whose spacing grows with their distance
/// from the car. For a path with a single curvature step, the computed ramp length S is exact, not
/// an approximation. The sampling of the path's steering stops at the ends and cusps of the path.
double PreviewDistance(const ControlInput& input, double delay = 0.0);

/// Limits how fast a controller's preview distance shrinks over time. PreviewDistance grows when a
/// curvature step enters the previewed range, and shrinks at once when the step leaves this range.
/// A preview point that moved backwards would make the steering command jump. HeldPreviewDistance
/// therefore shrinks by at most the distance that the car drives, so the preview point never moves
/// backwards. After a change of the direction of motion, HeldPreviewDistance starts again with the
/// result of PreviewDistance.
class HeldPreviewDistance {
 public:
  /// Returns the preview distance R [m] for the car's present state, with `delay` [s] added to the
  /// response time. Call Next once per control period.
  double Next(const ControlInput& input, double delay = 0.0);

 private:
  double distance_ = 0.0;  // Last preview distance [m]; 0 before the first call.
  int direction_ = 0;      // Direction of motion on the path.
};

/// Returns the shortest preview distance [m] with which a rate-limited car at `speed` returns from
/// `offset` [m] to its path without oscillation and without sliding. At the maximum steering rate,
/// the curvature of the car's motion changes by c = omega/(L v) per meter, with the wheelbase L.
/// The distance of a return from an offset e is proportional to cbrt(e/c), with the curvature
/// change c per meter. ReturnDistance also includes the distance v T that the car drives before it
/// responds. The response time T of ReturnDistance excludes the control period. At a speed v below
/// 5/4 L omega, the curvature change omega/(L v) per meter is computed for v = 5/4 L omega. The
/// returned distance is at least v sqrt(2 e/a), with the offset e and the acceleration a =
/// kReturnGripShare LateralGrip (steering_limit.h). The bound v sqrt(2 e/a) limits the lateral
/// acceleration to a, since an arc toward a point at the distance R has the lateral acceleration 2
/// e v^2/R^2.
double ReturnDistance(const VehicleParams& vehicle, double speed, double offset);

/// Computes ReturnDistance (see above) for the car's present speed and its present offset from the
/// path.
double ReturnDistance(const ControlInput& input);

}  // namespace trackbed
