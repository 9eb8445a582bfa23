#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Whether the avoider handles an obstacle: the avoider handles obstacles in a turn, replanning all
/// others. If only one of avoider and replanning is configured, that one handles all obstacles.
bool IsForAvoider(const ReplanningConfig& config, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle);

/// Tracks which obstacles are known and plans again when due. The avoider plans around blocking
/// obstacles after its delay; replanning runs at its period.
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

  /// Returns a plan to adopt, if one is due. `at` is the car's projection onto `plan`. Update()
  /// must be called once per control period, from time 0 on.
  std::optional<FeasiblePlan> Update(const VehicleState& state, const Plan& plan,
                                     const Projection& at);

  /// Whether a car that stopped before the end of its route may still continue. A stopped car may
  /// continue if a moving obstacle may clear the way or no replanning was tried since the stop.
  [[nodiscard]] bool IsWaiting() const;

 private:
  struct Knowledge {
    std::optional<double> since;  ///< Time at which the obstacle became known [s].
    bool avoided = false;         ///< Whether the avoider's plans take the obstacle into account.
  };

  void UpdateKnowledge(const VehicleState& state);
  std::optional<FeasiblePlan> Avoid(const VehicleState& state, const Plan& plan, double station);
  /// Known obstacles that replanning must handle, at their present positions.
  [[nodiscard]] std::vector<MovingBox> KnownObstacles(const VehicleState& state, const Path& path,
                                                      double station) const;
  /// Whether a newly known obstacle cannot wait for the next period. Comfortable braking from the
  /// next period on would bring the car too close to an urgent obstacle.
  [[nodiscard]] bool IsUrgent(const VehicleState& state, const Plan& plan,
                              const Projection& at) const;
  /// Available deceleration on the path ahead, over the stopping distance [m/s^2]. The deceleration
  /// is the minimum friction under the footprint, reduced by downhill slopes and by the lateral
  /// force in bends at the car's speed. The available deceleration is 0 if unknown.
  [[nodiscard]] double HardestBraking(const Path& path, double station, double speed) const;
  std::optional<FeasiblePlan> ReplanIfDue(const VehicleState& state, const Plan& plan,
                                          const Projection& at);
  [[nodiscard]] ReplanRequest RequestFor(const VehicleState& state, const Plan& plan,
                                         const Projection& at) const;
  /// The car's station on the route [m], searched within the car's motion in a replanning period.
  [[nodiscard]] double StationOnRoute(const VehicleState& state) const;
  void SetRoute(const Plan& plan);
  /// Conditions of the road that new plans must meet.
  [[nodiscard]] RoadConditions Road() const;

  Options options_;
  std::vector<Knowledge> knowledge_;  // what is known of each obstacle
  Driving driving_;
  long periods_ = 0;      // Number of replanning periods so far.
  bool gave_up_ = false;  // Whether the last replanning started at rest and found no motion.
};

}  // namespace trackbed
