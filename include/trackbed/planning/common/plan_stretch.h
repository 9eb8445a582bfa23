#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// Copies stretches of a plan into another plan, with shifted stations.
namespace trackbed {

/// Returns the schedule's knots that lie strictly between two distances, shifted by `shift` [m].
std::vector<SteeringSchedule::Knot> Moved(const SteeringSchedule& schedule, Stations within,
                                          double shift);

/// Returns the open-loop steering between two distances, with a knot at each end. The distances of
/// the knots count from `within.from`.
std::vector<SteeringSchedule::Knot> SteeringBetween(const SteeringSchedule& schedule,
                                                    Stations within);

/// Returns the parts of speed caps that lie between two stations, shifted by `shift` [m].
std::vector<SpeedCap> Moved(const std::vector<SpeedCap>& caps, Stations within, double shift);

/// Returns the turns of which the part from the first ramp to the middle lies between two stations,
/// shifted by `shift` [m].
std::vector<IsolatedTurn> Moved(const std::vector<IsolatedTurn>& turns, Stations within,
                                double shift);

/// Returns the segments of a path between two stations. The path continues straight before its
/// start and beyond its end, so that a car that was pushed beyond an end still has a path. The
/// result is empty if no segment remains.
std::vector<Segment> SegmentsBetween(const Path& path, Stations within);

template <typename T>
void Append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Returns the speed caps of a plan. For a plan at the car's limit, these are the planned speeds,
/// as caps on stretches of at most 0.5 m.
std::vector<SpeedCap> CapsOf(const Plan& plan);

/// Returns the part of a plan beyond `station`, for a car that is at `station` with `start_speed`
/// [m/s]. The stations of the result count from `station`. The diagnostics of turns are copied
/// unchanged. A plan at the car's limit keeps its speeds; a slower car accelerates to these speeds
/// with the acceleration of `speed`.
Plan RemainingPlan(const Plan& plan, double station, double start_speed, const SpeedLimits& speed);

}  // namespace trackbed
