#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Computes the largest accelerations of a car on a path from the road's friction, friction patches
/// and slope. If the friction under the two axles differs, the lower friction applies.
///
/// Symbols: theta is the slope of the road; mu_x and mu_y are the tyres' friction coefficients
/// along and across the path, times the friction factor of the road. On a slope theta, the load on
/// the tyres is the load on a flat road times cos(theta). Gravity reduces three limits: the
/// deceleration downhill, the acceleration uphill, and the lateral acceleration where gravity pulls
/// toward the outside of a bend. On a cross slope, gravity's pull uses a part of the tyres'
/// friction ellipse, which reduces the acceleration and the deceleration on a straight. Gravity
/// never raises an acceleration limit of the car.
class RoadHold {
 public:
  /// Keeps a reference to the plan request, and uses its vehicle, friction, friction patches and
  /// ground.
  explicit RoadHold(const PlanRequest& request);

  /// Returns the largest lateral acceleration v^2 |kappa| [m/s^2] at a station with the given
  /// signed curvature [1/m]. The limit is mu_y g cos(theta) minus gravity's pull, with the lateral
  /// friction mu_y and the slope theta. For curvature 0, returns the smaller of the limits in a
  /// left and a right bend. Returns 0 if the lateral limit is unknown, or if gravity's pull exceeds
  /// the tyres' grip.
  [[nodiscard]] double Lateral(const Path& path, double s, double curvature) const;

  /// Returns the largest deceleration of the car at a station [m/s^2]; 0 if the limit is unknown,
  /// or if gravity exceeds the grip.
  [[nodiscard]] double Braking(const Path& path, double s) const;

  /// Returns the largest acceleration of the car at a station [m/s^2]; 0 if the limit is unknown,
  /// or if gravity exceeds the grip.
  [[nodiscard]] double Driving(const Path& path, double s) const;

  /// The combined acceleration along and across the path that a plan requires, and the limit of
  /// this acceleration.
  struct Combined {
    /// Required acceleration, increased by gravity's opposing pull [m/s^2].
    double required = 0.0;
    /// Limit of the friction ellipse in the direction of the required acceleration [m/s^2]; 0:
    /// unknown.
    double limit = 0.0;
  };

  /// Combines the acceleration `along` the path [m/s^2], positive forwards, with the lateral
  /// acceleration `across` = v^2 kappa [m/s^2], positive to the left.
  [[nodiscard]] Combined Both(const Path& path, double s, double along, double across) const;

  /// Returns the largest lateral acceleration v^2 |kappa| [m/s^2] at a station with the given
  /// signed curvature, while the car accelerates with `along` [m/s^2]. The returned acceleration is
  /// negative if gravity and the acceleration `along` together exceed the tyres' grip, and infinite
  /// if the grip is unknown.
  [[nodiscard]] double LateralBeside(const Path& path, double s, double curvature,
                                     double along) const;

  /// Gravity's pull on the car along the slope, and the largest pull that tyres, brakes and drive
  /// can resist.
  struct Pull {
    double pull = 0.0;  ///< Pull of gravity on the car [m/s^2], >= 0.
    double hold = 0.0;  ///< Largest pull of gravity that the car can resist [m/s^2]; 0: unknown.
  };

  /// Returns gravity's pull along the path, across the path or combined, whichever is closest to
  /// the largest pull that the car can resist. If gravity's pull exceeds the largest pull that the
  /// car can resist, the car slides. On flat ground, returns 0 for gravity's pull and 0 for the
  /// pull that the car can resist.
  [[nodiscard]] Pull Slope(const Path& path, double s) const;

  /// Returns the road's friction factor under a car at a pose: the lower of the factors under the
  /// two axles.
  [[nodiscard]] double Factor(const Pose2& pose) const;

  /// Returns the factor on the tyres' friction force at a station: the friction factor of the road
  /// times the cosine of its slope.
  [[nodiscard]] double FrictionAt(const Path& path, double s) const;

  [[nodiscard]] bool flat() const { return flat_; }
  /// Whether the road is flat and has the same friction everywhere.
  [[nodiscard]] bool uniform() const { return flat_ && request_.friction_patches.empty(); }

 private:
  /// The slope of the ground under the car, as direction cosines of gravity.
  struct Tilt {
    double load = 1.0;  ///< Cosine of the slope's angle.
    double up = 0.0;    ///< Sine of the rise angle in the direction of travel.
    double left = 0.0;  ///< Sine of the rise angle to the left of the car.
  };

  /// The grip of the tyres and the required accelerations at a station.
  struct Demand {
    /// Semi-axis of the friction ellipse along the path [m/s^2]; 0: unknown.
    double grip_along = 0.0;
    /// Semi-axis of the friction ellipse across the path [m/s^2]; 0: unknown.
    double grip_across = 0.0;
    /// Required acceleration along the path, increased by gravity's opposing pull [m/s^2].
    double along = 0.0;
    double pull_across = 0.0;  ///< Gravity's pull toward the outside of the bend [m/s^2], >= 0.

    [[nodiscard]] bool is_known() const { return grip_along > 0.0 && grip_across > 0.0; }
  };

  /// Computes the tyres' grip and the required accelerations at a station; `side` has the sign of
  /// the curvature.
  [[nodiscard]] Demand DemandAt(const Path& path, double s, double along, double side) const;
  /// Limits the acceleration `along` the path [m/s^2] to the part of the friction ellipse that
  /// gravity's pull across the path leaves. The argument `road` is the road's factor on the tyres'
  /// friction.
  [[nodiscard]] double BesideSlope(double along, double road, const Tilt& tilt) const;
  [[nodiscard]] Tilt TiltAt(const PathPoint& at) const;

  const PlanRequest& request_;
  bool flat_;
};

/// The smallest value of each limit of RoadHold over a part of a path, sampled every 0.1 m. The
/// smallest value of an acceleration limit is 0 if the limit is unknown, or if gravity exceeds the
/// grip.
struct RoadHoldLimits {
  /// Smallest value of the lateral acceleration limit along the part of the path, for bends to
  /// either side [m/s^2].
  double lateral = 0.0;
  /// Smallest value of the deceleration limit along the part of the path [m/s^2].
  double braking = 0.0;
  /// Smallest value of the forward acceleration limit along the part of the path [m/s^2].
  double driving = 0.0;
};
RoadHoldLimits MinRoadHold(const Path& path, Stations within, const PlanRequest& request);

}  // namespace trackbed
