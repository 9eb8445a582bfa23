#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "trackbed/control/surroundings.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Collects the surroundings that controllers may know. The world must outlive the LoopSurroundings
/// object.
class LoopSurroundings final : public Surroundings {
 public:
  LoopSurroundings(const World& world, const VehicleParams& vehicle);

  /// Begins a control period of the car in `state` on `plan`. The plan must not change until the
  /// next call of BeginPeriod. A known obstacle stays known until the end of the run.
  void BeginPeriod(const VehicleState& state, const Plan& plan);
  /// Call ForgetPath when the car begins another plan or another segment.
  void ForgetPath() { edges_.reset(); }

  [[nodiscard]] const std::vector<SeenObstacle>& Obstacles() const override;
  [[nodiscard]] const PathEdges& Edges() const override;
  [[nodiscard]] double RoadFriction() const override;

 private:
  const World* world_;
  const VehicleParams* vehicle_;
  std::vector<bool> known_;  // Whether each obstacle of the world is known.
  VehicleState state_;
  const Plan* plan_ = nullptr;
  // The following members are computed when a controller needs them.
  mutable bool sees_ = false;               // Whether the obstacles are collected for this period.
  mutable std::vector<SeenObstacle> seen_;  // Walls of the map, followed by known obstacles.
  mutable std::optional<PathEdges> edges_;  // Edges beside the present path.
};

}  // namespace trackbed
