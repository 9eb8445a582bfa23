#pragma once

#include <optional>

#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Detects the collisions of one run at every physics step. CollisionWatch also checks the motion
/// between two steps, since the car may pass through a thin obstacle within one step.
class CollisionWatch {
 public:
  /// World and vehicle must outlive the CollisionWatch, which keeps references to both.
  CollisionWatch(const World& world, const VehicleParams& vehicle);

  /// Checks the plant's state at `time` [s]. Call Update at the start of the run and after every
  /// physics step.
  void Update(const Plant& plant, double time);

  /// Smallest clearance and largest contact force since the last call of Take.
  struct Period {
    /// Minimum clearance between car and obstacles [m]; 0 in a collision; none without obstacles.
    std::optional<double> clearance;
    double force = 0.0;  ///< Largest contact force between car and obstacles [N].
  };
  Period Take();

  /// Returns the time of the first contact with an obstacle [s]; none if the car touched no
  /// obstacle.
  [[nodiscard]] const std::optional<double>& contact_time() const { return contact_time_; }

 private:
  void Note(double clearance, double time);

  const World& world_;
  const VehicleParams& vehicle_;
  std::optional<Pose2> pose_;  // Pose of the car at the last update.
  double time_ = 0.0;          // Time of the last update [s].
  double clearance_ = 0.0;     // Clearance between car and obstacles at the last update [m].
  Period period_;
  std::optional<double> contact_time_;
};

}  // namespace trackbed
