#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Which local planner an obstacle is for: one in a turn for the avoider, any other for replanning;
/// if there is only one of the two, all are its.
bool IsForAvoider(const ReplanningConfig& config, const VehicleParams& vehicle, const Path& path,
                  double station, const OrientedBox& obstacle);

/// Notices obstacles as they become known, and plans again when that is due: around those that
/// stand in the way once the avoider's delay has passed, and at the period of replanning.
class ReplanningMonitor {
 public:
  struct Options {
    ReplanningConfig replanning{};
    VehicleParams vehicle{};  ///< as planners take it to be
    World world{};
    std::uint64_t seed = 0;
  };

  /// `plan` is the one that the run begins with.
  ReplanningMonitor(const Options& options, const Plan& plan);

  /// The new plan, if one is to be taken up, for a car that is `at` on `plan`. Asked once per
  /// control period, from time 0 on.
  std::optional<Plan> Update(const VehicleState& state, const Plan& plan, const Projection& at);

  /// Whether a car at rest before the end of its route may yet go on: something that is in its way
  /// moves, or no new plan has been tried since it came to rest.
  [[nodiscard]] bool IsWaiting() const;

 private:
  struct Knowledge {
    std::optional<double> since;  ///< when the obstacle became known [s]
    bool avoided = false;         ///< the avoider's plans take it into account
  };

  void UpdateKnowledge(const VehicleState& state);
  std::optional<Plan> Avoid(const VehicleState& state, const Plan& plan, double station);
  /// What is known by now and is for replanning, where it is now.
  [[nodiscard]] std::vector<MovingBox> KnownObstacles(const VehicleState& state, const Path& path,
                                                      double station) const;
  /// Whether something that became known this moment cannot wait for the next period: a car that
  /// brakes comfortably from then on would get too near.
  [[nodiscard]] bool IsUrgent(const VehicleState& state, const Plan& plan,
                              const Projection& at) const;
  /// The hardest braking on the path ahead, as far as the car takes to stop with it: the least
  /// friction under its footprint, what bends leave of it at its speed, and downhill [m/s^2]. 0:
  /// not known.
  [[nodiscard]] double HardestBraking(const Path& path, double station, double speed) const;
  std::optional<Plan> ReplanIfDue(const VehicleState& state, const Plan& plan,
                                  const Projection& at);
  [[nodiscard]] ReplanRequest RequestFor(const VehicleState& state, const Plan& plan,
                                         const Projection& at) const;
  /// Where the car is on the route, near where it can have got to in a period of replanning [m].
  [[nodiscard]] double StationOnRoute(const VehicleState& state) const;
  void SetRoute(const Plan& plan);

  Options options_;
  std::vector<Knowledge> knowledge_;  // obstacle by obstacle
  Driving driving_;
  long periods_ = 0;      // of replanning, so far
  bool gave_up_ = false;  // the last replanning was from rest, and nothing but standing is left
};

}  // namespace trackbed
