#pragma once

#include <cstddef>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

/// The surroundings of a car, as far as controllers may know them.
namespace trackbed {

/// An obstacle or a wall at the beginning of a control period.
struct SeenObstacle {
  OrientedBox footprint;         ///< Footprint in the world.
  Vec2 velocity = Vec2::Zero();  ///< Velocity of the obstacle's center in the world [m/s].
  double yaw_rate = 0.0;         ///< Yaw rate [rad/s].
};

/// Distances from a point of a plan to the edges of its track, along the line through the point
/// that is perpendicular to the center line of the track [m].
struct EdgeDistances {
  double left = 0.0;   ///< Distance to the track's left edge; negative if it is right of the path.
  double right = 0.0;  ///< Distance to the track's right edge; negative if it is left of the path.
};

/// The edges of a track along a path, at the stations 0, `spacing`, 2 `spacing`, ... [m].
struct PathEdges {
  double spacing = 0.0;  ///< Distance between two stations [m], > 0.
  /// Track edges at each station; empty if there is no track.
  std::vector<EdgeDistances> distances{};

  /// Returns the edges at a station [m]. The distances of the edges are linear between the stations
  /// and constant before the first and beyond the last station. `distances` must not be empty.
  [[nodiscard]] EdgeDistances At(double station) const;
};

/// The surroundings of the car in one control period. Each member of the surroundings is computed
/// when a controller first requests it; the returned references are valid until the end of the
/// control period.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Returns all walls, and the obstacles that planners know (Obstacle::known_from_time).
  [[nodiscard]] virtual const std::vector<SeenObstacle>& Obstacles() const = 0;
  /// Returns the edges of the plan's track beside its present path.
  [[nodiscard]] virtual const PathEdges& Edges() const = 0;
  /// Returns the road's factor on the friction of the tyres at the car [1], > 0.
  [[nodiscard]] virtual double RoadFriction() const = 0;
};

/// Interface of a SteeringController that uses the surroundings of the car. A controller class that
/// is derived from SteeringController and SeesSurroundings sees the surroundings in every control
/// period, even through the wrappers of MakeSteeringController. A class that is derived from
/// SeesSurroundings must define SteeringController::Clone, because CopyableController hides
/// SeesSurroundings.
class SeesSurroundings {
 public:
  virtual ~SeesSurroundings() = default;
  /// Receives the surroundings of the car; called before SteeringController::Steer in each control
  /// period. `surroundings` is valid until the end of the period.
  virtual void See(const Surroundings& surroundings) = 0;
};

}  // namespace trackbed
