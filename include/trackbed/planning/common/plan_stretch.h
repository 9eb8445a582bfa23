#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// Stretches of a plan, shifted to the stations of another plan that contains them.
namespace trackbed {

/// The schedule's knots strictly between two distances, shifted by `shift`.
std::vector<SteeringSchedule::Knot> Moved(const SteeringSchedule& schedule, Stations within,
                                          double shift);

/// The open-loop steering between two distances, with a knot at each end. Distances count from the
/// first one.
std::vector<SteeringSchedule::Knot> SteeringBetween(const SteeringSchedule& schedule,
                                                    Stations within);

/// The parts of the caps that lie within two stations, shifted by `shift`.
std::vector<SpeedCap> Moved(const std::vector<SpeedCap>& caps, Stations within, double shift);

/// The turns that lie within two stations from the first ramp to the middle, shifted by `shift`.
std::vector<IsolatedTurn> Moved(const std::vector<IsolatedTurn>& turns, Stations within,
                                double shift);

/// The segments between two stations, including the straight continuations before the start and
/// beyond the end. A car that was pushed beyond an end of its path thus still has a path. Empty if
/// nothing remains.
std::vector<Segment> SegmentsBetween(const Path& path, Stations within);

template <typename T>
void Append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// The caps of a plan. For a plan at the car's limit, they are its speeds, as caps of at most 0.5
/// m.
std::vector<SpeedCap> CapsOf(const Plan& plan);

/// The plan beyond `station`, with stations counted from there, starting at `start_speed` [m/s].
/// The method's diagnostics of turns stay unchanged. A plan at the car's limit keeps its speeds; a
/// slower car accelerates to these speeds with the limits' acceleration.
Plan RemainingPlan(const Plan& plan, double station, double start_speed, const SpeedLimits& speed);

}  // namespace trackbed
