#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/track/track.h"

/// Laps and track limits of a run on a track (Plan::laps).
namespace trackbed {

/// Laps that the rear axle completed, timed between crossings of the start line by linear
/// interpolation between rows. A first lap that begins on or after the line starts with the run.
/// Empty without a track.
std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan);

/// Distance from a footprint to the nearest edge [m]. If the footprint crosses an edge, the
/// negative distance of its outermost point. `near` is the station of the footprint's center [m].
/// The footprint is sampled by its corners and 15 points on each long side; edges are polylines.
double TrackMargin(const Track& track, const OrientedBox& footprint, double near);

/// Smallest TrackMargin of the run [m], with its place. None without a track.
std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input);
/// Time with a negative TrackMargin [s]. None without a track.
std::optional<MetricReading> TimeOffTrack(const MetricInput& input);
/// Distance driven with a negative TrackMargin [m]. None without a track.
std::optional<MetricReading> DistanceOffTrack(const MetricInput& input);

}  // namespace trackbed
