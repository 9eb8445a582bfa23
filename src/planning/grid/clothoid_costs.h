#pragma once

#include <vector>

#include "trackbed/planning/grid/hybrid_astar.h"

namespace trackbed {

/// The speeds and the costs of paths of continuous curvature.
///
/// Symbols: v is the speed of the mission [m/s], w the speed on a segment [m/s], L the wheelbase
/// [m], sigma the sharpness [1/m^2]. At the speed w, the steering angle atan(L kappa) changes at
/// the rate L w sigma/(1 + (L kappa)^2) <= L w sigma.
class ClothoidCosts {
 public:
  ClothoidCosts(const VehicleParams& vehicle, const HybridAStarOptions& options,
                const ClothoidDrive& drive, double radius);

  /// Returns the speed at which the car drives a segment [m/s]. The speed on a segment is at most
  /// the larger of the mission's speed v and the start speed.
  [[nodiscard]] double SpeedOn(const Segment& segment) const;

  /// Returns the cost of a segment after the segment `before`, which is empty at the start [m].
  [[nodiscard]] double Of(const Segment& before, const Segment& segment, bool is_reverse) const;

  /// Returns the largest sharpness of a clothoid at a speed [1/m^2].
  [[nodiscard]] double SharpnessAt(double speed) const;

  /// Returns the speeds for which clothoids are made, fastest first [m/s].
  [[nodiscard]] std::vector<double> Speeds() const;

  /// Returns the largest curvature at a speed [1/m].
  [[nodiscard]] double CurvatureAt(double speed) const;

  /// Returns whether a car that rolls at the start has room to slow down for a segment that begins
  /// `length` m after the start.
  [[nodiscard]] bool BrakesFor(const Segment& segment, double length) const;

 private:
  const VehicleParams& vehicle_;
  const HybridAStarOptions& options_;
  const ClothoidDrive& drive_;
  double radius_;
  double lateral_acceleration_;
};

}  // namespace trackbed
