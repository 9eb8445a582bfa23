#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Largest accelerations of a car on a path, from the road's friction, patches and slope. If the
/// axles are on different friction, the lower friction applies.
///
/// Symbols: theta slope of the road; mu friction factor of the road times the tyres' coefficient.
/// The tyres' load is that of a flat road times cos(theta). Gravity reduces the limits: braking
/// downhill, driving uphill, and the lateral limit if it pulls toward the outside of a bend.
/// Gravity never raises a limit.
class RoadHold {
 public:
  /// Keeps a reference to the request, whose vehicle, friction, patches and ground are used.
  explicit RoadHold(const PlanRequest& request);

  /// Largest v^2 |kappa| [m/s^2] at a station with that signed curvature [1/m]: mu_y g cos(theta),
  /// minus gravity. With curvature 0, the smaller value of both sides. 0 if unknown, or if gravity
  /// exceeds the grip.
  [[nodiscard]] double Lateral(const Path& path, double s, double curvature) const;

  /// Largest deceleration [m/s^2]. 0 if unknown, or if gravity exceeds the grip.
  [[nodiscard]] double Braking(const Path& path, double s) const;

  /// Largest acceleration [m/s^2]. 0 if unknown, or if gravity exceeds the grip.
  [[nodiscard]] double Driving(const Path& path, double s) const;

  /// The acceleration that a plan needs along and across the path together, and its limit.
  struct Combined {
    double required = 0.0;  ///< Required acceleration, with gravity's pull against it [m/s^2].
    double limit =
        0.0;  ///< Limit in the same direction, by the friction ellipse [m/s^2]; 0: unknown.
  };

  /// Combines the acceleration `along` the path [m/s^2], positive forwards, with v^2 kappa =
  /// `across` [m/s^2], positive to the left.
  [[nodiscard]] Combined Both(const Path& path, double s, double along, double across) const;

  /// Largest v^2 |kappa| [m/s^2] at a station with that signed curvature, while the car accelerates
  /// with `along` [m/s^2]. Negative if gravity and `along` need more than the grip; infinite if
  /// unknown.
  [[nodiscard]] double LateralBeside(const Path& path, double s, double curvature,
                                     double along) const;

  /// Gravity's pull along the slope, and the largest pull that tyres, brakes and drive can hold.
  struct Pull {
    double pull = 0.0;  ///< Pull of gravity [m/s^2], >= 0.
    double hold = 0.0;  ///< Largest pull that can be held [m/s^2]; 0: unknown.
  };

  /// The pull along or across the path, whichever is closer to its limit. If the pull exceeds the
  /// limit, the car slides. The result is {0, 0} on flat ground.
  [[nodiscard]] Pull Slope(const Path& path, double s) const;

  [[nodiscard]] bool flat() const { return flat_; }
  /// Whether the road is the same everywhere.
  [[nodiscard]] bool uniform() const { return flat_ && request_.friction_patches.empty(); }

 private:
  /// The slope under the car, as direction cosines of gravity.
  struct Tilt {
    double load = 1.0;  ///< Cosine of the slope.
    double up = 0.0;    ///< Sine of the rise in the direction of travel.
    double left = 0.0;  ///< Sine of the rise to the left of the car.
  };

  /// Grip and demand at a station.
  struct Demand {
    double grip_along =
        0.0;  ///< Semi-axis of the friction ellipse along the path [m/s^2]; 0: unknown.
    double grip_across = 0.0;  ///< Semi-axis across the path [m/s^2]; 0: unknown.
    double along = 0.0;  ///< Acceleration along the path, with gravity's pull against it [m/s^2].
    double pull_across = 0.0;  ///< Gravity's pull toward the outside of the bend [m/s^2], >= 0.

    [[nodiscard]] bool is_known() const { return grip_along > 0.0 && grip_across > 0.0; }
  };

  /// `side` has the sign of the curvature.
  [[nodiscard]] Demand DemandAt(const Path& path, double s, double along, double side) const;
  [[nodiscard]] double Factor(const Pose2& pose) const;
  [[nodiscard]] Tilt TiltAt(const PathPoint& at) const;

  const PlanRequest& request_;
  bool flat_;
};

/// The minimum of each limit over the stations `within` of a path, sampled every 0.1 m. 0 if
/// unknown, or if gravity exceeds the grip.
struct RoadHoldLimits {
  double lateral = 0.0;  ///< Lateral limit, the smaller one of both sides [m/s^2].
  double braking = 0.0;  ///< Limit of braking [m/s^2].
  double driving = 0.0;  ///< Limit of driving [m/s^2].
};
RoadHoldLimits MinRoadHold(const Path& path, Stations within, const PlanRequest& request);

}  // namespace trackbed
