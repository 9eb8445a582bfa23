#pragma once

#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Largest accelerations of a car on a path, from the road's friction, patches and slope. With
/// axles on different friction, the more slippery axle decides.
///
/// Symbols: theta slope of the road, mu its factor times the tyres' coefficient. The tyres' load is
/// that of a flat road times cos(theta). Gravity is subtracted where it pulls against the car:
/// downhill from braking, uphill from driving, toward the outside of a bend from the lateral limit.
/// It is never added.
class RoadHold {
 public:
  /// Keeps a reference to the request: its vehicle, friction, patches and ground.
  explicit RoadHold(const PlanRequest& request);

  /// Largest v^2 |kappa| [m/s^2] at a station with that signed curvature [1/m]: mu_y g cos(theta),
  /// less gravity. With curvature 0, the smaller value of both sides. 0: unknown, or nothing is
  /// left.
  [[nodiscard]] double Lateral(const Path& path, double s, double curvature) const;

  /// Largest deceleration [m/s^2]. 0: unknown, or nothing is left.
  [[nodiscard]] double Braking(const Path& path, double s) const;

  /// Largest acceleration [m/s^2]. 0: unknown, or nothing is left.
  [[nodiscard]] double Driving(const Path& path, double s) const;

  /// Gravity's pull along the slope, and the most that tyres, brakes and drive hold against it.
  struct Pull {
    double pull = 0.0;  ///< [m/s^2], >= 0
    double hold = 0.0;  ///< [m/s^2]; 0: unknown
  };

  /// Pull along or across the path, whichever is closer to its limit. If it exceeds the limit, the
  /// car slides. {0, 0} on flat ground.
  [[nodiscard]] Pull Slope(const Path& path, double s) const;

  [[nodiscard]] bool flat() const { return flat_; }
  /// Whether the road is the same everywhere.
  [[nodiscard]] bool uniform() const { return flat_ && request_.friction_patches.empty(); }

 private:
  /// The slope under the car, in units of gravity.
  struct Tilt {
    double load = 1.0;  ///< cosine of the slope
    double up = 0.0;    ///< sine of the rise in the direction of travel
    double left = 0.0;  ///< sine of the rise to the left of the car
  };

  [[nodiscard]] double Factor(const Pose2& pose) const;
  [[nodiscard]] Tilt TiltAt(const PathPoint& at) const;

  const PlanRequest& request_;
  bool flat_;
};

/// Minimum of each limit over the stations `within` of a path, sampled every 0.1 m. 0: unknown, or
/// nothing is left.
struct RoadHoldLimits {
  double lateral = 0.0;  ///< [m/s^2], of either side
  double braking = 0.0;  ///< [m/s^2]
  double driving = 0.0;  ///< [m/s^2]
};
RoadHoldLimits MinRoadHold(const Path& path, Stations within, const PlanRequest& request);

}  // namespace trackbed
