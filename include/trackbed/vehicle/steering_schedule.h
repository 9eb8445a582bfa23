#pragma once

#include <vector>

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"

/// The steering angle as a function of the distance, for a car whose wheels turn at a limited rate
/// (Skackauskas, dissertation, listing F.1, with corrected distances).
///
/// Symbols: D distance traveled by the rear axle [m]; d_0 neutral angle of the wheels before,
/// between and after turns [rad]; S_delta = v |delta - d_0|/omega_delta the driven distance while
/// the wheels turn from d_0 to delta.
namespace trackbed {

/// One turn. The wheels start to turn toward `steering` at `start`, and back toward neutral at
/// `end`.
struct TurnSteering {
  double start = 0.0;     ///< Distance at which the turn starts [m], >= 0.
  double end = 0.0;       ///< Distance at which the turn ends [m], > start.
  double steering = 0.0;  ///< Steering angle [rad], positive to the left.
};

/// The steering angle delta as a continuous, piecewise linear function of the distance D. The angle
/// moves toward the current target with the slope omega_delta/v, then stays constant. A turn that
/// is long enough to reach its target is a trapezoid; a shorter turn stays below its target. A turn
/// that starts while the wheels still return from the previous turn takes effect immediately.
class SteeringSchedule {
 public:
  struct Knot {
    double distance = 0.0;  ///< Distance D [m].
    double steering = 0.0;  ///< Steering angle [rad].
  };

  /// Makes a schedule that steers straight ahead.
  SteeringSchedule() = default;

  /// Makes a schedule of turns in the order of their starts. `slope` = omega_delta/v [rad/m] > 0,
  /// one for all turns or one for each turn. `neutral` is the neutral angle d_0 [rad].
  /// InternalError if the turns are out of order.
  SteeringSchedule(const std::vector<TurnSteering>& turns, double slope, double neutral = 0.0);
  SteeringSchedule(const std::vector<TurnSteering>& turns, const std::vector<double>& slopes,
                   double neutral = 0.0);

  /// Makes a schedule through the knots, at least one, in strictly increasing order of distance.
  /// InternalError if the knots are out of order; PreconditionError unless the knots are finite.
  static SteeringSchedule Through(std::vector<Knot> knots);

  /// Makes a schedule with the constant angle `steering` [rad].
  static SteeringSchedule Constant(double steering);

  /// Returns the steering angle [rad] at a distance; constant before the first and after the last
  /// knot. If the distance is NaN, the result is NaN.
  [[nodiscard]] double At(double distance) const;

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  /// Returns the part of the schedule beyond `distance` [m], shifted so that it starts at D = 0.
  [[nodiscard]] SteeringSchedule From(double distance) const;

 private:
  std::vector<Knot> knots_;
};

/// The distance S_delta [m] that is driven at `speed` while the wheels turn by `steering`.
double SteeringDistance(const VehicleParams& params, double steering, double speed);

/// Returns the heading change [rad] of the rear-axle kinematic car at `speed` while the steering
/// moves from zero to `steering` at the full rate: (v/(L omega)) (-ln cos delta), with the sign of
/// the steering.
double RampHeading(const VehicleParams& params, double steering, double speed);

/// Returns the pose of the rear axle after the steering ramp of RampHeading; the car starts at the
/// origin along x. The pose is computed by quadrature of the heading and is exact to rounding.
Pose2 RampPose(const VehicleParams& params, double steering, double speed);

/// Returns the end state of an open-loop run of the kinematic car from `start` over `distance` [m].
/// The wheels follow the schedule exactly, as a car does whose speed keeps the schedule within the
/// steering rate limit. A start speed < 0 means driving backwards. `start` and the result are
/// states of the reference point. The integration is of fourth order in `step` [m], split at the
/// schedule's knots. InternalError for a start speed of 0.
KinematicState RollOut(const VehicleParams& params, const KinematicState& start,
                       const SteeringSchedule& schedule, double distance, double step,
                       ReferencePoint reference = ReferencePoint::kRearAxle);

/// The states of an open-loop run at several nondecreasing distances [m].
std::vector<KinematicState> RollOut(const VehicleParams& params, const KinematicState& start,
                                    const SteeringSchedule& schedule,
                                    const std::vector<double>& distances, double step,
                                    ReferencePoint reference = ReferencePoint::kRearAxle);

}  // namespace trackbed
