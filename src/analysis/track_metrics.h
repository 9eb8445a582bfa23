#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/track/track.h"

/// Measures the laps of a run on a track (Plan::laps), and how far the car stays within the track's
/// edges.
namespace trackbed {

/// Measures the laps that the rear axle completed. The times at which the rear axle crosses the
/// start line are interpolated linearly between log rows. If the run begins on or after the start
/// line, the first lap begins at the start of the run. MeasureLaps returns an empty list if the
/// plan has no track.
std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan);

/// Returns the distance from a car's footprint to the nearest edge of the track [m]. If the
/// footprint crosses an edge, TrackMargin returns the negative distance from the edge to the
/// footprint's outermost point. `near` is the station of the footprint's center [m]. The distance
/// is computed for the footprint's corners and for 15 points on each long side; the track edges are
/// polylines.
double TrackMargin(const Track& track, const OrientedBox& footprint, double near);

/// Returns the smallest TrackMargin of the run [m], with its station and time, or nullopt if the
/// run has no track.
std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input);
/// Returns the smallest TrackMargin of a car that follows the path of the plan exactly, up to the
/// finish line [m]; none if the run has no track. Poses on the path are at most a fifth of the
/// wheelbase apart, and at most Track::kEdgeSpacing.
/// The margin ignores a trailer.
std::optional<MetricReading> PlannedTrackMargin(const MetricInput& input);
/// Returns the total time during which TrackMargin is negative [s]; none if the run has no track.
std::optional<MetricReading> TimeOffTrack(const MetricInput& input);
/// Returns the distance driven while TrackMargin is negative [m], or nullopt if the run has no
/// track.
std::optional<MetricReading> DistanceOffTrack(const MetricInput& input);

}  // namespace trackbed
