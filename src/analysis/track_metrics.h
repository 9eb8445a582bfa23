#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/track/track.h"

/// Laps and track limits of a run on a track (Plan::laps).
namespace trackbed {

/// The laps that the rear axle completed: between crossings of the start line, linear between the
/// rows of the log. A first lap that begins on the line or after it counts from the start of the
/// run. None without a track.
std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan);

/// Distance of a footprint from the nearest edge [m], negative where it reaches beyond one: then
/// that of its outermost point. `near` is a station of the track by the footprint's middle [m].
/// The footprint is its corners and 15 points on either long side, the edges are their polylines.
double TrackMargin(const Track& track, const OrientedBox& footprint, double near);

/// The smallest TrackMargin of the run [m], with its moment. None without a track.
std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input);
/// Time with a negative TrackMargin [s]. None without a track.
std::optional<MetricReading> TimeOffTrack(const MetricInput& input);
/// Distance driven with a negative TrackMargin [m]. None without a track.
std::optional<MetricReading> DistanceOffTrack(const MetricInput& input);

}  // namespace trackbed
