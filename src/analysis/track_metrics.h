#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/track/track.h"

/// Measures laps and track limits of a run on a track (Plan::laps).
namespace trackbed {

/// Measures the laps that the rear axle completed. The times at which the rear axle crosses the
/// start line are interpolated linearly between log rows. If the run begins on or after the start
/// line, the first lap begins at the start of the run. MeasureLaps returns no laps if the plan has
/// no track.
std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan);

/// Returns the distance from a car's footprint to the nearest edge of the track [m]. If the
/// footprint crosses an edge, TrackMargin returns the negative distance from the edge to the
/// footprint's outermost point. `near` is the station of the footprint's center [m]. The footprint
/// is sampled at its corners and at 15 points on each long side; edges are polylines.
double TrackMargin(const Track& track, const OrientedBox& footprint, double near);

/// Returns the smallest TrackMargin of the run [m], with its station and time; none without a
/// track.
std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input);
/// Returns the total time during which TrackMargin is negative [s]; none without a track.
std::optional<MetricReading> TimeOffTrack(const MetricInput& input);
/// Returns the distance driven while TrackMargin is negative [m]; none without a track.
std::optional<MetricReading> DistanceOffTrack(const MetricInput& input);

}  // namespace trackbed
