#include "trackbed/planning/replan/predicted_conflict.h"

#include <algorithm>
#include <cmath>

#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/replan/detour.h"
#include "trackbed/world/world.h"

namespace trackbed {

std::optional<PredictedConflict> PredictConflict(const VehicleParams& vehicle,
                                                 const Reference& reference, double station,
                                                 const std::vector<MovingBox>& obstacles,
                                                 double distance, double look_ahead,
                                                 double offset) {
  constexpr double kStep = 0.1;  // [s]
  constexpr double kTolerance =
      1e-2;  // Tolerance [m], needed because planners check the clearance only at samples.
  // Use only the part of the profile ahead of the car, because a stop behind the car would make the
  // arrival times at all later stations infinite.
  const SpeedProfile ahead =
      Excerpt(reference.speed, {station, std::max(station, reference.path.length())});
  const auto station_at = [&](double time) { return station + ahead.StationAt(time); };
  const auto too_near = [&](double time, const MovingBox& obstacle) {
    const OrientedBox footprint =
        FootprintAt(vehicle, Compose(reference.path.At(station_at(time)).pose, {0.0, offset, 0.0}));
    return Separation(footprint, obstacle.At(time)) < distance - kTolerance;
  };
  const auto steps = static_cast<int>(std::ceil(look_ahead / kStep));
  for (int i = 0; i <= steps; ++i) {
    const double time = i * kStep;
    for (std::size_t j = 0; j < obstacles.size(); ++j) {
      if (too_near(time, obstacles[j])) {
        // Find the time of the first conflict by bisection, because a car at 15 m/s moves by 1.5 m
        // in a time step of 0.1 s.
        double clear = i == 0 ? time : time - kStep;
        double near = time;
        for (int halving = 0; halving < 10 && i > 0; ++halving) {
          const double middle = 0.5 * (clear + near);
          (too_near(middle, obstacles[j]) ? near : clear) = middle;
        }
        return PredictedConflict{near, station_at(near), j};
      }
    }
  }
  return std::nullopt;
}

bool StandsInTurn(const VehicleParams& vehicle, const Path& path, double station,
                  const OrientedBox& obstacle, double distance) {
  constexpr double kMinBendCurvature = 1e-3;  // [1/m]
  const std::vector<Stations> stretches =
      BlockedStretches(vehicle, path, station, {obstacle}, distance);
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stations& stretch) {
    const std::vector<Segment> within = path.Cut(stretch);
    return std::any_of(within.begin(), within.end(), [&](const Segment& segment) {
      return std::abs(segment.curvature) > kMinBendCurvature ||
             std::abs(segment.CurvatureAt(segment.length)) > kMinBendCurvature;
    });
  });
}

bool MightClear(const VehicleParams& vehicle, const Path& path, double station,
                const std::vector<MovingBox>& obstacles, double distance) {
  constexpr double kLookAheadDistance = 30.0;  // Length of the path that is searched [m].
  constexpr double kLookAheadTime = 60.0;      // Duration that is searched [s].
  constexpr double kStep = 0.5;                // Step of the search in station [m] and in time [s].
  for (const MovingBox& obstacle : obstacles) {
    if (obstacle.velocity == Vec2::Zero()) {
      continue;
    }
    for (double s = station; s <= std::min(station + kLookAheadDistance, path.length());
         s += kStep) {
      const OrientedBox footprint = FootprintAt(vehicle, path.At(s).pose);
      for (double time = 0.0; time <= kLookAheadTime; time += kStep) {
        if (Separation(footprint, obstacle.At(time)) < distance) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace trackbed
