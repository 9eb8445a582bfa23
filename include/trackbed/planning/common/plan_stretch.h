#pragma once

#include <vector>

#include "trackbed/planning/common/planner.h"

/// Stretches of a plan, in stations of another that they become part of.
namespace trackbed {

/// Open-loop steering strictly between two distances, moved along by `shift`.
std::vector<SteeringSchedule::Knot> Moved(const SteeringSchedule& schedule, Stations within,
                                          double shift);

/// What lies of each cap within.
std::vector<SpeedCap> Moved(const std::vector<SpeedCap>& caps, Stations within, double shift);

/// The turns that lie within as far as they are looked at, from the first ramp to their middle.
std::vector<IsolatedTurn> Moved(const std::vector<IsolatedTurn>& turns, Stations within,
                                double shift);

/// The segments between two stations, the straight continuations before the start and beyond the
/// end included: a car that was thrown off the ends of its path has a way to go on. None where
/// nothing is left.
std::vector<Segment> SegmentsBetween(const Path& path, Stations within);

template <typename T>
void Append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// The plan's caps; of a plan at the car's limit its speeds as caps, each at most 0.5 m long.
std::vector<SpeedCap> CapsOf(const Plan& plan);

/// What lies ahead of `station`, its stations counted from there, left at `start_speed` [m/s]. What
/// the method told of its turns stays as it was. A plan at the car's limit keeps its speeds; a car
/// that is slower there comes up to them at the limits' acceleration.
Plan RemainingPlan(const Plan& plan, double station, double start_speed, const SpeedLimits& speed);

}  // namespace trackbed
