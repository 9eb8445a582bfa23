#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// Functions for copying stretches of a plan into another plan, with shifted stations.
namespace trackbed {

/// Returns the knots of a steering schedule that lie strictly between two driven distances, shifted
/// by `shift` [m].
std::vector<SteeringSchedule::Knot> Moved(const SteeringSchedule& schedule, Stations within,
                                          double shift);

/// Returns the part of a steering schedule between two driven distances, with a knot at each end.
/// The driven distances of the returned knots count from `within.from`.
std::vector<SteeringSchedule::Knot> SteeringBetween(const SteeringSchedule& schedule,
                                                    Stations within);

/// Returns the parts of the speed caps that lie between two stations, shifted by `shift` [m].
std::vector<SpeedCap> Moved(const std::vector<SpeedCap>& caps, Stations within, double shift);

/// Returns the turns whose first half, from the start of the steering ramp to the middle of the
/// arc, lies between two stations, shifted by `shift` [m].
std::vector<IsolatedTurn> Moved(const std::vector<IsolatedTurn>& turns, Stations within,
                                double shift);

/// Returns the segments of a path between two stations. The path is extended straight before its
/// start and beyond its end, so that a car that was pushed beyond an end still has a path. Returns
/// an empty list if no segment lies between the stations.
std::vector<Segment> SegmentsBetween(const Path& path, Stations within);

template <typename T>
void Append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Returns the speed caps of a plan. For a plan with speeds at the car's limit, the returned speed
/// caps are the planned speeds on stretches of at most 0.5 m.
std::vector<SpeedCap> CapsOf(const Plan& plan);

/// Returns the part of a plan beyond `station`, for a car that is at `station` with `start_speed`
/// [m/s]. The stations of the returned plan count from the given `station`. The diagnostics of
/// turns are copied to the returned plan unchanged. The returned plan keeps speeds that were
/// planned at the car's limit. A car that is slower than planned first accelerates to the planned
/// speeds with the acceleration in `speed`.
Plan RemainingPlan(const Plan& plan, double station, double start_speed, const SpeedLimits& speed);

}  // namespace trackbed
