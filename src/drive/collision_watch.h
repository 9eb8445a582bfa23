#pragma once

#include <optional>

#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Watches one run for collisions, at every physics step and between them: two steps may lie on
/// either side of a thin obstacle.
class CollisionWatch {
 public:
  /// Refers to world and vehicle, which must outlive it.
  CollisionWatch(const World& world, const VehicleParams& vehicle);

  /// Looks at the plant as it is at `time` [s], at the start and after every step.
  void Update(const Plant& plant, double time);

  /// What was seen since the last time it was asked.
  struct Period {
    std::optional<double> clearance;  ///< smallest [m]; 0 in a collision; none without obstacles
    double force = 0.0;               ///< largest contact force with obstacles [N]
  };
  Period Take();

  /// When the car first touched an obstacle [s]; none: it has not.
  [[nodiscard]] const std::optional<double>& contact_time() const { return contact_time_; }

 private:
  void Note(double clearance, double time);

  const World& world_;
  const VehicleParams& vehicle_;
  std::optional<Pose2> pose_;  // at the last update
  double time_ = 0.0;          // likewise [s]
  double clearance_ = 0.0;     // likewise [m]
  Period period_;
  std::optional<double> contact_time_;
};

}  // namespace trackbed
