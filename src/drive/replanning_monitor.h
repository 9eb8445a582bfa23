#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Which local planner handles an obstacle: the avoider those in a turn, replanning all others. If
/// only one of the two is configured, it handles all.
bool IsForAvoider(const ReplanningConfig& config, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle);

/// Tracks which obstacles are known, and plans again when due: around obstacles in the way after
/// the avoider's delay, and at the period of replanning.
class ReplanningMonitor {
 public:
  struct Options {
    ReplanningConfig replanning{};
    VehicleParams vehicle{};  ///< nominal vehicle, known to the planners
    World world{};
    std::uint64_t seed = 0;
  };

  /// `plan` is the initial plan of the run.
  ReplanningMonitor(const Options& options, const FeasiblePlan& plan);

  /// Returns a plan to adopt, if one is due, for a car at the projection `at` on `plan`. Must be
  /// called once per control period, from time 0 on.
  std::optional<FeasiblePlan> Update(const VehicleState& state, const Plan& plan,
                                     const Projection& at);

  /// Whether a car that stopped before the end of its route may still continue: a moving obstacle
  /// may clear the way, or no replanning was tried since the stop.
  [[nodiscard]] bool IsWaiting() const;

 private:
  struct Knowledge {
    std::optional<double> since;  ///< time at which the obstacle became known [s]
    bool avoided = false;         ///< the avoider's plans take it into account
  };

  void UpdateKnowledge(const VehicleState& state);
  std::optional<FeasiblePlan> Avoid(const VehicleState& state, const Plan& plan, double station);
  /// Known obstacles that replanning must handle, at their present positions.
  [[nodiscard]] std::vector<MovingBox> KnownObstacles(const VehicleState& state, const Path& path,
                                                      double station) const;
  /// Whether a newly known obstacle cannot wait for the next period: with comfortable braking from
  /// then on, the car would come too close to it.
  [[nodiscard]] bool IsUrgent(const VehicleState& state, const Plan& plan,
                              const Projection& at) const;
  /// Available deceleration on the path ahead, over the stopping distance [m/s^2]: the minimum
  /// friction under the footprint, reduced by lateral force in bends at the car's speed and by
  /// downhill slopes. 0 if unknown.
  [[nodiscard]] double HardestBraking(const Path& path, double station, double speed) const;
  std::optional<FeasiblePlan> ReplanIfDue(const VehicleState& state, const Plan& plan,
                                          const Projection& at);
  [[nodiscard]] ReplanRequest RequestFor(const VehicleState& state, const Plan& plan,
                                         const Projection& at) const;
  /// The car's station on the route, searched within the motion of a replanning period [m].
  [[nodiscard]] double StationOnRoute(const VehicleState& state) const;
  void SetRoute(const Plan& plan);
  /// What new plans are held to.
  [[nodiscard]] RoadConditions Road() const;

  Options options_;
  std::vector<Knowledge> knowledge_;  // for each obstacle
  Driving driving_;
  long periods_ = 0;      // replanning periods so far
  bool gave_up_ = false;  // the last replanning was from rest and found no motion
};

}  // namespace trackbed
