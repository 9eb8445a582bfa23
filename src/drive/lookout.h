#pragma once

#include <optional>
#include <vector>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/replan/replan.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {

/// Which local planner an obstacle is for: one in a turn for the avoider, any other for replanning;
/// if there is only one of the two, all are its.
bool IsForAvoider(const PlanSpec& spec, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle);

SpeedLimits SpeedLimitsOf(const Scenario& scenario);

/// Notices obstacles as they become known, and plans again when that is due: around those that
/// stand in the way once the avoider's delay has passed, and at the period of replanning.
class Lookout {
 public:
  Lookout(const Scenario& scenario, const VehicleParams& vehicle, const Plan& plan);

  /// The new plan, if one is to be taken up. `station` is the car's on the plan that is driven.
  std::optional<Plan> Look(const VehicleState& state, const Plan& plan, const Projection& at);

  /// Whether a car at rest before the end of its route may yet go on: something that is in its way
  /// moves, or nothing has been tried since it came to rest.
  [[nodiscard]] bool Waits() const;

 private:
  struct Seen {
    std::optional<double> since;  ///< when it became known [s]
    bool taken_in = false;        ///< the avoider reckons with it
  };

  void See(const VehicleState& state);
  std::optional<Plan> Avoid(const VehicleState& state, const Plan& plan, double station);
  /// What has become known, where it is now, for replanning.
  [[nodiscard]] std::vector<MovingBox> Known(const VehicleState& state, const Path& path,
                                             double station) const;
  /// Whether something that became known this moment cannot wait for the next look: a car that
  /// brakes comfortably from then on would get too near.
  [[nodiscard]] bool IsUrgent(const VehicleState& state, const Plan& plan,
                              const Projection& at) const;
  /// The hardest braking on the path ahead, as far as the car takes to stop with it: the least
  /// friction under its outline, what bends leave of it at its speed, and downhill [m/s^2]. 0: not
  /// known.
  [[nodiscard]] double HardestBraking(const Path& path, double station, double speed) const;
  std::optional<Plan> PlanAgain(const VehicleState& state, const Plan& plan, const Projection& at);
  void SetRoute(const Plan& plan);

  const Scenario& scenario_;
  const VehicleParams& vehicle_;
  std::vector<Seen> seen_;  // obstacle by obstacle
  Driving driving_;
  long looks_ = 0;        // of replanning, so far
  bool gave_up_ = false;  // the last look was from rest, and nothing but standing is left
};

}  // namespace trackbed
