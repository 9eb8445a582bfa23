#pragma once

#include <optional>

#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Detects collisions in one run, at every physics step and between steps, which may be on either
/// side of a thin obstacle.
class CollisionWatch {
 public:
  /// Keeps references to world and vehicle, which must outlive it.
  CollisionWatch(const World& world, const VehicleParams& vehicle);

  /// Must be called at the start and after every step, with the plant's state at `time` [s].
  void Update(const Plant& plant, double time);

  /// Clearance and force since the last call of Take.
  struct Period {
    std::optional<double> clearance;  ///< minimum [m]; 0 in a collision; none without obstacles
    double force = 0.0;               ///< largest contact force with obstacles [N]
  };
  Period Take();

  /// Time of the first contact with an obstacle [s]; none without contact.
  [[nodiscard]] const std::optional<double>& contact_time() const { return contact_time_; }

 private:
  void Note(double clearance, double time);

  const World& world_;
  const VehicleParams& vehicle_;
  std::optional<Pose2> pose_;  // at the last update
  double time_ = 0.0;          // at the last update [s]
  double clearance_ = 0.0;     // at the last update [m]
  Period period_;
  std::optional<double> contact_time_;
};

}  // namespace trackbed
