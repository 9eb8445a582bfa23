#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Predicts conflicts of a plan with obstacles that stand or move at constant velocity.
namespace trackbed {

/// The first conflict on a plan: time and place at which the car, following the plan, will come too
/// close to a known obstacle.
struct PredictedConflict {
  double time = 0.0;     ///< Time from the prediction until the conflict [s].
  double station = 0.0;  ///< Station of the car on the plan at the conflict [m].
  std::size_t obstacle = 0;
};

/// Predicts the first conflict with an obstacle for a car that drives the plan from `station` on,
/// at the planned speeds and `offset` [m] to the left of the plan. PredictConflict tests for a
/// conflict every 0.1 s, and then finds the start of the conflict to 0.1 ms by bisection. Returns
/// nullopt if there is no conflict within the time `look_ahead` [s].
std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset = 0.0);

/// Returns whether an obstacle stands in a turn. An obstacle stands in a turn if the path beyond
/// `station` is curved at a place where the car is closer to the obstacle than `distance` [m].
bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance);

/// Returns whether waiting may clear the path. Waiting may clear the path if a moving obstacle is,
/// at present or within a minute, closer than `distance` [m] to the next 30 m of the path.
bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance);

}  // namespace trackbed
