#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Returns whether the avoider handles an obstacle. The avoider handles obstacles in a turn, and
/// replanning handles all other obstacles. If only the avoider or only replanning is configured, it
/// handles all obstacles.
bool IsForAvoider(const ReplanningConfig& config, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle);

/// Tracks which obstacles are known, and makes new plans during a run. The avoider plans around a
/// blocking obstacle after a configured delay; replanning runs periodically.
class ReplanningMonitor {
 public:
  struct Options {
    ReplanningConfig replanning{};
    VehicleParams vehicle{};  ///< parameters of the nominal vehicle, which the planners assume
    World world{};
    std::uint64_t seed = 0;
  };

  /// `plan` is the initial plan of the run.
  ReplanningMonitor(const Options& options, const FeasiblePlan& plan);

  /// Returns a new plan for the car, or nullopt if no new plan is due. `at` is the car's projection
  /// onto its present plan `plan`. Call Update once per control period, from time 0 on.
  std::optional<FeasiblePlan> Update(const VehicleState& state, const Plan& plan,
                                     const Projection& at);

  /// Returns whether a car that stopped before the end of its route may still continue. A stopped
  /// car may continue if a moving obstacle may clear the way, or if no replanning has run since the
  /// stop.
  [[nodiscard]] bool IsWaiting() const;

 private:
  struct Knowledge {
    std::optional<double> since;  ///< Time at which the obstacle became known [s].
    bool avoided = false;         ///< Whether the avoider's plans take the obstacle into account.
  };

  void UpdateKnowledge(const VehicleState& state);
  std::optional<FeasiblePlan> Avoid(const VehicleState& state, const Plan& plan, double station);
  /// Returns the known obstacles that replanning must handle, at their present positions.
  [[nodiscard]] std::vector<MovingBox> KnownObstacles(const VehicleState& state, const Path& path,
                                                      double station) const;
  /// Returns whether a newly known obstacle is so close that comfortable braking from the next
  /// replanning period on could not stop the car in time.
  [[nodiscard]] bool IsUrgent(const VehicleState& state, const Plan& plan,
                              const Projection& at) const;
  /// Returns the deceleration that the road ahead permits over the stopping distance [m/s^2]. The
  /// permitted deceleration depends on the lowest friction under the footprint, minus the effects
  /// of downhill slopes and of lateral forces in bends. HardestBraking returns 0 if the car's
  /// deceleration limit is unknown.
  [[nodiscard]] double HardestBraking(const Path& path, double station, double speed) const;
  std::optional<FeasiblePlan> ReplanIfDue(const VehicleState& state, const Plan& plan,
                                          const Projection& at);
  [[nodiscard]] ReplanRequest RequestFor(const VehicleState& state, const Plan& plan,
                                         const Projection& at) const;
  /// Returns the car's station on the route [m]. StationOnRoute searches around the previous
  /// station, within the distance that the car can move in a replanning period.
  [[nodiscard]] double StationOnRoute(const VehicleState& state) const;
  void SetRoute(const Plan& plan);
  /// Returns the road conditions that new plans must meet.
  [[nodiscard]] RoadConditions Road() const;

  Options options_;
  std::vector<Knowledge> knowledge_;  // One element for each obstacle of the world.
  Driving driving_;
  long periods_ = 0;      // Number of replanning periods so far.
  bool gave_up_ = false;  // Whether the last replanning started at rest and found no motion.
};

}  // namespace trackbed
