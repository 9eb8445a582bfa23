#pragma once

#include <optional>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/replan/predicted_conflict.h"
#include "trackbed/planning/replan/replan.h"

/// Plans that stop the car along the path of its driven plan.
namespace trackbed {

/// Returns whether an obstacle stands still.
bool Stands(const MovingBox& obstacle);

/// A plan that stops the car, and the deceleration of the stop.
struct BrakingPlan {
  Plan plan;
  double deceleration = 0.0;  ///< [m/s^2]
};

/// Chooses the deceleration of a stop. The car brakes comfortably if possible, otherwise as hard as
/// necessary, up to its limit. The arguments of the constructor must outlive the object.
class StopPlanner {
 public:
  StopPlanner(const ReplanRequest& request, const Driving& driving, const ReplanOptions& options)
      : request_(request), driving_(driving), options_(options) {}

  /// Plans a stop from `speed` [m/s] before the place of the conflict. Returns nullopt if the car
  /// is already at the end of its plan, or if braking causes an earlier conflict with a moving
  /// obstacle.
  [[nodiscard]] std::optional<BrakingPlan> StopBefore(const PredictedConflict& conflict,
                                                      double speed) const;

  /// Makes a plan that stops the car from `speed` over the distance `way` along the driven plan. A
  /// comfortable stop is at the end of the driven plan if this end is nearer than `way`.
  [[nodiscard]] Plan StopAfter(double way, double speed, bool comfortable) const;

  /// Returns the deceleration of an ordinary stop [m/s^2].
  [[nodiscard]] double ComfortableBraking() const;

 private:
  [[nodiscard]] std::optional<PredictedConflict> FirstConflict(const Plan& plan) const;

  /// Returns whether the next conflict of the braking plan `plan` is not earlier than `conflict`.
  /// An earlier conflict is possible, because braking can cause a collision from behind.
  [[nodiscard]] bool DelaysConflict(const Plan& plan, const PredictedConflict& conflict) const;

  /// Returns the largest deceleration that the car can achieve [m/s^2]; on ice, it is less than the
  /// comfortable deceleration and replaces it.
  [[nodiscard]] double HardestBraking() const;

  /// Returns the deceleration that stops the car from `speed` within `room` [m], clamped to the
  /// range between the comfortable and the largest deceleration.
  [[nodiscard]] double BrakingWithin(double room, double speed) const;

  /// Returns the smallest deceleration with which the car hits no known obstacle, moving obstacles
  /// included; if a collision is unavoidable, returns the largest deceleration.
  [[nodiscard]] double BrakingFor(double speed) const;

  const ReplanRequest& request_;
  const Driving& driving_;
  const ReplanOptions& options_;
};

}  // namespace trackbed
