#pragma once

#include <optional>

#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Detects collisions of one run at every physics step. Motion between steps is also checked, since
/// a step may cross a thin obstacle.
class CollisionWatch {
 public:
  /// The watch keeps references to world and vehicle, which must outlive it.
  CollisionWatch(const World& world, const VehicleParams& vehicle);

  /// Update() must be called at the start and after every step, with the plant's state at `time`
  /// [s].
  void Update(const Plant& plant, double time);

  /// Clearance and contact force since the last call of Take.
  struct Period {
    std::optional<double> clearance;  ///< Minimum clearance [m]; 0 in a collision; none without
                                      ///< obstacles.
    double force = 0.0;               ///< Largest contact force with obstacles [N].
  };
  Period Take();

  /// Time of the first contact with an obstacle [s]; none if there is no contact.
  [[nodiscard]] const std::optional<double>& contact_time() const { return contact_time_; }

 private:
  void Note(double clearance, double time);

  const World& world_;
  const VehicleParams& vehicle_;
  std::optional<Pose2> pose_;  // Pose of the car at the last update.
  double time_ = 0.0;          // Time of the last update [s].
  double clearance_ = 0.0;     // Clearance at the last update [m].
  Period period_;
  std::optional<double> contact_time_;
};

}  // namespace trackbed
