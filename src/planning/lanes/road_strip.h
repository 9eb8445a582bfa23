#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// A short piece of a road with its drivable lanes. Locate finds the place on the road surface that
/// lies below a point.
class RoadStrip {
 public:
  /// Place on the road surface below a point. To locate points beside the road, the surface is
  /// extended sideways beyond the lanes and straight beyond the ends of the strip.
  struct Place {
    double s = 0.0;       ///< Station of the place within the strip [m].
    double z = 0.0;       ///< Height of the road surface at the place [m].
    double beside = 0.0;  ///< Distance of the place from the nearest lane; 0 on the lanes [m].
    /// Distance from the end of the strip to a place beyond this end; 0 within the strip [m].
    double beyond = 0.0;
    double straight_on = 0.0;  ///< Part of `beyond` that lies on the straight extension of the road
                               ///< [m].
    /// Factor from 0 to 1 by which the height `z` counts in the mean height of nearby strips.
    /// The weight factor of a strip falls to 0 toward the road's center of curvature.
    double share = 1.0;
  };

  /// Makes a strip between two stations, which must lie within one lane section and one piece of
  /// the reference line. The road extends straight by `before` [m] before the strip and by `after`
  /// [m] after the strip. The road must outlive the strip.
  RoadStrip(const Road& road, double from, double to, double before, double after);

  /// Finds the place on the road surface below a point. Returns nullopt for a point near or beyond
  /// the road's center of curvature.
  [[nodiscard]] std::optional<Place> Locate(const Vec2& point_W) const;

  [[nodiscard]] const Road& road() const { return *road_; }
  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }
  /// Returns the lateral coordinates t of the outermost borders of the drivable lanes [m], the
  /// right border first.
  [[nodiscard]] std::pair<double, double> Borders(double s) const;
  /// Center and radius of a circle that contains the lanes.
  [[nodiscard]] const Vec2& middle() const { return middle_; }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  struct Node {
    Vec2 position;
    Vec2 tangent;  // Derivative of the position with respect to the station.
  };
  [[nodiscard]] Node ReferenceAt(double s) const;

  const Road* road_;
  std::size_t section_ = 0;
  double from_ = 0.0;
  double to_ = 0.0;
  double before_ = 0.0;
  double after_ = 0.0;
  int leftmost_ = 0;  // Number of the leftmost drivable lane.
  int rightmost_ = 0;
  double curvature_ = 0.0;   // Mean curvature [1/m].
  std::vector<Node> nodes_;  // Evenly spaced nodes.
  Vec2 middle_{0.0, 0.0};
  double radius_ = 0.0;
};

/// Cuts a road between two stations into strips, without stretches that have no drivable lane.
std::vector<RoadStrip> CutIntoStrips(const Road& road, double from, double to, double before,
                                     double after);

}  // namespace trackbed
