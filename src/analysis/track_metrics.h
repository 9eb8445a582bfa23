#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/track/track.h"

/// Measures laps and track limits of a run on a track (Plan::laps).
namespace trackbed {

/// Laps that the rear axle completed. Crossings of the start line are timed by linear interpolation
/// between rows. If the first lap begins on or after the start line, the time of that lap begins
/// with the run. MeasureLaps returns nothing without a track.
std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan);

/// Distance from a footprint to the nearest edge of the track [m]. If the footprint crosses an
/// edge, the margin is the negative distance of the footprint's outermost point. `near` is the
/// station of the footprint's center [m]. The footprint is sampled at its corners and at 15 points
/// on each long side; edges are polylines.
double TrackMargin(const Track& track, const OrientedBox& footprint, double near);

/// Smallest TrackMargin of the run [m], with its station and time. SmallestTrackMargin returns none
/// without a track.
std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input);
/// Time of the run with a negative TrackMargin [s]. TimeOffTrack returns none without a track.
std::optional<MetricReading> TimeOffTrack(const MetricInput& input);
/// Distance driven with a negative TrackMargin [m]. DistanceOffTrack returns none without a track.
std::optional<MetricReading> DistanceOffTrack(const MetricInput& input);

}  // namespace trackbed
