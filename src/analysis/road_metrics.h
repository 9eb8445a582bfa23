#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// The drivable lanes of roads, each road a band between the outermost borders of its drivable
/// lanes. Borders are sampled every half meter: on a curve of radius r, a border is accurate to
/// (0.5 m)^2/(8 r).
class RoadBands {
 public:
  /// Largest distance outside the band of a road at which Inside finds the band [m].
  static constexpr double kReach = 10.0;

  /// Makes the bands of those roads that pass the rectangle between two corners, or pass at a
  /// distance of at most kReach from the rectangle.
  RoadBands(const RoadNetwork& network, const Vec2& low, const Vec2& high);

  /// Returns the distance from a point to the nearer border of a road's band, negative outside the
  /// band [m]. Where the bands of several roads overlap, Inside returns the largest distance.
  /// Returns nullopt if the point is not abeam of the band of any road, for example before the
  /// beginning of a road.
  [[nodiscard]] std::optional<double> Inside(const Vec2& point) const;

 private:
  /// The part of a band between two neighboring stations.
  struct Piece {
    std::pair<Vec2, Vec2> right;  // Right border at both stations of the piece.
    std::pair<Vec2, Vec2> left;
  };

  void Add(const Road& road, double from, double to, const Vec2& low, const Vec2& high);
  void Sort();
  [[nodiscard]] int BinOf(double along, double low, int count) const;

  std::vector<Piece> pieces_;
  Vec2 low_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::size_t>> bins_;  // Indices of the pieces that reach each bin.
};

/// Returns the smallest distance of the footprint from the edges of the roads in a run; negative if
/// the car leaves the roads. SmallestRoadMargin measures the distance at points of the footprint's
/// outline at most half a meter apart. Returns nullopt for a plan that does not follow the lanes of
/// roads.
std::optional<MetricReading> SmallestRoadMargin(const MetricInput& input);

}  // namespace trackbed
