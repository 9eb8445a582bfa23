#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/planning/replan/along_route.h"

/// The parts of PlanAlongRoute that concern leaders: finding, following and passing them.
///
/// Symbols: as in trackbed/planning/replan/along_route.h.
namespace trackbed {

/// Finds the nearest obstacle in the car's way up to the station `to`; nullopt if the way is clear.
std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to);

/// Returns the distance from the car's rear axle to its front [m].
double FrontOverAxle(const VehicleParams& vehicle);

/// Returns the distance that the car keeps from each obstacle [m]. A car that starts closer to an
/// obstacle than the safe distance may keep its present distance.
std::vector<double> ClearanceMargins(const AlongRequest& request, const AlongSettings& settings,
                                     const Pose2& start);

/// Returns the index of the first obstacle to which the car comes closer than its margin; nullopt
/// if the points are clear. Ignores points of the motion up to the time `from`. The motion begins
/// `shift` [s] after the present.
std::optional<std::size_t> FirstTooNear(const AlongRequest& request,
                                        const std::vector<double>& margins,
                                        const std::vector<TrajectoryPoint>& points, double from,
                                        double shift = 0.0);

/// Returns whether the car at the offset `d` [m] clears the leader laterally, at its present
/// offsets, by the safe distance.
bool ClearsLaterally(const AlongRequest& request, const AlongSettings& settings,
                     const Leader& leader, double d);

/// Returns the shortest distance [m] over which the car at the constant speed `speed` [m/s] can
/// move sideways by `aside` [m] with a quintic d(s). The limits are those of the steering angle,
/// the steering rate and the lateral acceleration. The computation of this distance assumes small
/// angles between the car and the road.
double ShiftLength(const VehicleParams& vehicle, const FrenetLimits& limits, double speed,
                   double aside);

/// Returns the time [s] that a car at the constant speed `speed` > 0 [m/s] needs for the longest
/// lateral move from the route to one of the method's end offsets on the road. The result is 0 for
/// a car that stands.
double LongestShiftTime(const VehicleParams& vehicle, const RoadWidths& road,
                        const AlongOptions& options, double speed);

/// Adds longer durations to the end times of the method `frenet`, if a slow car turns its wheels
/// too slowly to move to the side within the given end times. Each added duration is a quarter
/// longer than the duration before; the last one is at least a quarter longer than the
/// LongestShiftTime. The weights of time decrease as much as the longest duration increases.
/// Otherwise, the car would stay beside the route, because a slow return takes too long.
void AddTimesToShift(AlongOptions& options, const VehicleParams& vehicle, const RoadWidths& road,
                     double speed);

/// Returns the offsets [m] at which the car can pass the leader on the road. The result has the
/// offsets of the method's options that clear the leader, and, on each side, the nearest offset
/// that clears the leader. The list of offsets is empty if the road is too narrow.
std::vector<double> PassingOffsets(const AlongRequest& request, const AlongSettings& settings,
                                   const Leader& leader, const AlongOptions& options);

/// Returns the speeds [m/s] at which the car may pull out beside the leader, the fastest first. The
/// result has the speeds of the method's options above the leader's speed, then the leader's own
/// speed. A car that is slower than the leader does not pull out at the leader's speed, because
/// following the leader reaches this speed sooner. The list of speeds is empty if the leader is not
/// slower than the desired speed.
std::vector<double> PassingSpeeds(const AlongRequest& request, const Leader& leader,
                                  const AlongOptions& options);

/// Returns the options with which the method searches for motions that pull out to one of `offsets`
/// and end at `speed` [m/s], in the order in which to try them. The lateral offset is a function of
/// the station, unless the options say otherwise. An offset over the station needs a lower steering
/// rate of an accelerating car than an offset over time.
///
/// For the method `frenet`, the end times include the times that the steering needs to move aside
/// at `speed`. For the method `lattice`, the first options have a lattice of one layer, just long
/// enough for the steering to move aside. On a longer lattice, the car moves aside so slowly that a
/// new plan after each replanning period would postpone the maneuver.
std::vector<AlongOptions> PullOutOptions(AlongOptions options, const AlongRequest& request,
                                         const std::vector<double>& offsets, double speed);

/// Returns why the car could not finish passing the leader after `motion`; empty if it could. To
/// pass, the car accelerates at the last offset of the motion to the desired speed, or to a lower
/// speed. The car drives until its rear is the safe distance ahead of the leader's front, and
/// returns to the route. The whole maneuver must keep the safe distance from all obstacles, which
/// are extrapolated at constant velocity. Before the end of the route, the maneuver must leave the
/// distance that the car needs to brake to a stop. When the car stops at the end of the route, the
/// leader must still be behind the car. The final distance between car and leader must be at least
/// the distance that the car itself would keep from a leader.
std::string WhyNotPast(const RouteFrame& frame, const AlongRequest& request,
                       const AlongSettings& settings, const FrenetLimits& limits,
                       const Leader& leader, const FrenetMotion& motion);

/// Explains for people why no motion of a method pulls out, by the reasons that occur in
/// `rejected`. If `rejected` counts no rejection, the reason is that the car could not brake to a
/// stop after the motions.
std::string WhyNoPullOut(const RejectionCounts& rejected);

/// Explains for people that the road has no room beside the leader, with the room that the car
/// would need.
std::string WhyNoRoom(const AlongRequest& request, const AlongSettings& settings,
                      const Leader& leader);

}  // namespace trackbed
