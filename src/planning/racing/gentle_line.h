#pragma once

#include <cstddef>

#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// Finds lines without bends that are too tight for a car.
namespace trackbed {

struct GentleLine {
  TrackLine line;
  double curvature = 0.0;  ///< Largest |kappa| of the line at its stations [1/m].
  double s = 0.0;          ///< Station of the track at which |kappa| is largest [m].
};

/// Reduces the largest curvature of the line `start` at `count` stations, evenly spaced along the
/// track. The line keeps the distance `beside` [m] from the track's edges. Ends as soon as the
/// largest |kappa| is at most `curvature_max` [1/m].
///
/// Guarantees: the curvature of the result is at most that of `start`. If the curvature of the
/// result exceeds `curvature_max`, no small change of the line reduces it: the last quadratic
/// program predicts a decrease of less than 1e-4 of `curvature_max`. The minimum is local. Every
/// quadratic program of the reduction has a solution. The computing time is that of about 5
/// programs, each as large as one of FindMinimumCurvature.
GentleLine ReduceCurvature(const Track& track, double beside, const TrackLine& start,
                           double curvature_max, std::size_t count);

}  // namespace trackbed
