#pragma once

#include <optional>

#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Detects the collisions of the car and its trailer at every physics step of a run. CollisionWatch
/// also checks the motion between two steps, since the car may pass through a thin obstacle within
/// one step.
class CollisionWatch {
 public:
  /// The object `world` must outlive the CollisionWatch, which keeps a reference to `world`.
  CollisionWatch(const World& world, const VehicleParams& vehicle,
                 const std::optional<TrailerParams>& trailer = std::nullopt);

  /// Checks the plant's state at `time` [s]. Call Update at the start of the run and after every
  /// physics step.
  void Update(const Plant& plant, double time);

  /// Smallest clearance and largest contact force since the last call of Take.
  struct Period {
    /// Minimum clearance of car and trailer from the obstacles [m]; 0 in a collision, nullopt
    /// without obstacles.
    std::optional<double> clearance;
    double force = 0.0;  ///< Largest contact force between car and obstacles [N].
  };
  Period Take();

  /// Returns the time of the first contact with an obstacle [s], or nullopt if the car touched no
  /// obstacle.
  [[nodiscard]] const std::optional<double>& contact_time() const { return contact_time_; }

 private:
  /// Footprint of the car or its trailer, with its clearance from the obstacles at the last update.
  struct Body {
    VehicleParams shape;
    std::optional<ClearanceSample> last{};
  };

  void Update(Body& body, const Pose2& pose, double time);
  void Note(double clearance, double time);

  const World& world_;
  Body car_;
  std::optional<TrailerParams> trailer_;
  Body towed_;
  Period period_;
  std::optional<double> contact_time_;
};

}  // namespace trackbed
