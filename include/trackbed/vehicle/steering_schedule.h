#pragma once

#include <vector>

#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/params.h"

/// The steering schedule: the steering angle as a function of the distance traveled, for a car
/// whose wheels turn at a limited rate. The method of the steering schedule is that of Skackauskas
/// (dissertation, listing F.1), with corrected distances.
///
/// Symbols: D distance traveled by the rear axle [m]; d_0 neutral angle of the wheels before,
/// between and after turns [rad]; S_delta = v |delta - d_0|/omega_delta the driven distance while
/// the wheels turn from d_0 to delta.
namespace trackbed {

/// One turn of a steering schedule. At the distance `start`, the wheels start to turn toward the
/// angle `steering`; at the distance `end`, the wheels start to turn back toward the neutral angle.
struct TurnSteering {
  double start = 0.0;     ///< Distance traveled at which the turn starts [m], >= 0.
  double end = 0.0;       ///< Distance traveled at which the turn ends [m], > start.
  double steering = 0.0;  ///< Steering angle of the turn [rad], positive to the left.
};

/// The steering angle delta as a continuous, piecewise linear function of the distance D. The
/// steering angle changes toward the target angle with the slope omega_delta/v (maximum steering
/// rate per speed), and then stays constant. A turn that is long enough to reach its target angle
/// has the shape of a trapezoid; a shorter turn does not reach its target angle. If a turn starts
/// while the wheels still return from the previous turn, the wheels move toward the new target
/// angle immediately.
class SteeringSchedule {
 public:
  struct Knot {
    double distance = 0.0;  ///< Distance D [m].
    double steering = 0.0;  ///< Steering angle [rad].
  };

  /// Makes a schedule that steers straight ahead.
  SteeringSchedule() = default;

  /// Makes a schedule of turns, which must be in the order of their starts. The argument `slope` is
  /// omega_delta/v [rad/m], > 0: the steering rate divided by the speed, with one value for all
  /// turns or one value for each turn. The argument `neutral` is the neutral angle d_0 [rad].
  /// Throws InternalError if the turns of the schedule are out of order.
  SteeringSchedule(const std::vector<TurnSteering>& turns, double slope, double neutral = 0.0);
  SteeringSchedule(const std::vector<TurnSteering>& turns, const std::vector<double>& slopes,
                   double neutral = 0.0);

  /// Makes a schedule through the given knots (distance and steering angle), at least one, in
  /// strictly increasing order of distance. Throws InternalError if the knots of the schedule are
  /// not in order of distance. Throws PreconditionError unless all knots are finite.
  static SteeringSchedule Through(std::vector<Knot> knots);

  /// Makes a schedule with the constant angle `steering` [rad].
  static SteeringSchedule Constant(double steering);

  /// Returns the steering angle [rad] at a distance traveled. The steering angle is constant before
  /// the first knot and after the last knot. If the distance is NaN, the returned angle is NaN.
  [[nodiscard]] double At(double distance) const;

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

  /// Returns the part of the schedule beyond `distance` [m], shifted so that the returned part
  /// starts at D = 0.
  [[nodiscard]] SteeringSchedule From(double distance) const;

 private:
  std::vector<Knot> knots_;
};

/// Returns the distance S_delta [m] that is driven at `speed` while the wheels turn by the angle
/// `steering`.
double SteeringDistance(const VehicleParams& params, double steering, double speed);

/// Returns the heading change [rad] of a kinematic car at `speed` while its steering angle changes
/// from zero to `steering` at the full rate. The heading change is (v/(L omega)) (-ln cos delta),
/// with the sign of the steering, the speed v, the wheelbase L, the steering rate omega, and the
/// final steering angle delta.
double RampHeading(const VehicleParams& params, double steering, double speed);

/// Returns the pose of a kinematic car's rear axle after its steering angle has changed as in
/// RampHeading. RampPose starts the car at the origin, heading along x. The pose after the ramp is
/// computed by quadrature of the heading and is exact except for rounding errors.
Pose2 RampPose(const VehicleParams& params, double steering, double speed);

/// Simulates an open-loop run of the kinematic car from `start` over `distance` [m], and returns
/// the state at the end. The wheels follow the schedule exactly, which requires a speed at which
/// the schedule is within the steering rate limit. If the start speed is negative, the car drives
/// backwards. The start state and the returned state are states of the car's reference point
/// `reference`. The simulation uses integration of fourth order with steps of length `step` [m],
/// split at the schedule's knots. Throws InternalError if the start speed is 0.
KinematicState RollOut(const VehicleParams& params, const KinematicState& start,
                       const SteeringSchedule& schedule, double distance, double step,
                       ReferencePoint reference = ReferencePoint::kRearAxle);

/// Returns the states of an open-loop run at several distances [m], which must not decrease.
std::vector<KinematicState> RollOut(const VehicleParams& params, const KinematicState& start,
                                    const SteeringSchedule& schedule,
                                    const std::vector<double>& distances, double step,
                                    ReferencePoint reference = ReferencePoint::kRearAxle);

}  // namespace trackbed
