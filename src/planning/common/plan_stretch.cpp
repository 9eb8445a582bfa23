#include "trackbed/planning/common/plan_stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trackbed {
namespace {

/// Returns the part of a speed profile after the station `ahead.from`, for a car that starts there
/// with `speed`. A car slower than the profile accelerates with `acceleration` until it reaches the
/// profile's speed.
SpeedProfile JoinedBy(const SpeedProfile& profile, Stations ahead, double speed,
                      double acceleration) {
  std::vector<SpeedProfile::Knot> knots = Excerpt(profile, ahead).knots();
  for (SpeedProfile::Knot& knot : knots) {
    const double reached = std::sqrt(speed * speed + 2.0 * acceleration * knot.s);
    if (reached >= knot.speed) {
      break;
    }
    knot.speed = reached;
  }
  return SpeedProfile(std::move(knots));
}

}  // namespace

std::vector<SteeringSchedule::Knot> Moved(const SteeringSchedule& schedule, Stations within,
                                          double shift) {
  // Leave out knots at the ends of the stretch, because the adjacent pieces of the schedule have
  // their own knots there.
  constexpr double kCutTolerance = 1e-9;  // [m]
  std::vector<SteeringSchedule::Knot> knots;
  for (const SteeringSchedule::Knot& knot : schedule.knots()) {
    if (knot.distance > within.from + kCutTolerance && knot.distance < within.to - kCutTolerance) {
      knots.push_back({knot.distance + shift, knot.steering});
    }
  }
  return knots;
}

std::vector<SteeringSchedule::Knot> SteeringBetween(const SteeringSchedule& schedule,
                                                    Stations within) {
  std::vector<SteeringSchedule::Knot> knots{{0.0, schedule.At(within.from)}};
  Append(knots, Moved(schedule, within, -within.from));
  const double length = within.to - within.from;
  constexpr double kDistinct = 1e-9;  // [m]
  if (length > knots.back().distance + kDistinct) {
    knots.push_back({length, schedule.At(within.to)});
  }
  return knots;
}

std::vector<SpeedCap> Moved(const std::vector<SpeedCap>& caps, Stations within, double shift) {
  std::vector<SpeedCap> moved;
  for (const SpeedCap& cap : caps) {
    const double from = std::max(cap.from, within.from);
    const double to = std::min(cap.to, within.to);
    if (to > from) {
      moved.push_back({from + shift, to + shift, cap.speed, cap.strict});
    }
  }
  return moved;
}

std::vector<IsolatedTurn> Moved(const std::vector<IsolatedTurn>& turns, Stations within,
                                double shift) {
  std::vector<IsolatedTurn> moved;
  for (IsolatedTurn turn : turns) {
    if (turn.from >= within.from && turn.middle <= within.to) {
      turn.from += shift;
      turn.middle += shift;
      moved.push_back(turn);
    }
  }
  return moved;
}

std::vector<Segment> SegmentsBetween(const Path& path, Stations within) {
  std::vector<Segment> segments{{.length = std::min(0.0, within.to) - within.from}};
  Append(segments, path.Cut(within));
  segments.push_back({.length = within.to - std::max(within.from, path.length())});
  constexpr double kNegligible = 1e-9;  // [m]
  std::erase_if(segments, [](const Segment& piece) { return piece.length < kNegligible; });
  return segments;
}

std::vector<SpeedCap> CapsOf(const Plan& plan) {
  if (!plan.diagnostics.speed_profile) {
    return plan.caps;
  }
  std::vector<SpeedCap> caps;
  const std::vector<SpeedProfile::Knot>& knots = plan.reference.speed.knots();
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    // Use the larger of the two knot speeds, because the smaller speed may be 0 at the start or end
    // of a plan.
    caps.push_back({knots[i].s, knots[i + 1].s, std::max(knots[i].speed, knots[i + 1].speed)});
  }
  return caps;
}

Plan RemainingPlan(const Plan& plan, double station, double start_speed, const SpeedLimits& speed) {
  Plan rest = plan;
  const Path& path = plan.reference.path;
  const Stations ahead{station, path.length()};
  std::vector<SteeringSchedule::Knot> knots{{0.0, plan.schedule.At(station)}};
  Append(knots, Moved(plan.schedule, {station, std::numeric_limits<double>::infinity()}, -station));
  const double open_loop_end = plan.schedule_speed.knots().back().s - station;
  rest.reference.path = Path(path.At(station).pose, path.Cut(ahead));
  rest.schedule = SteeringSchedule::Through(std::move(knots));
  rest.caps = Moved(plan.caps, ahead, -station);
  rest.turns = Moved(plan.turns, ahead, -station);
  rest.stops.clear();  // The remaining speed profile has no stops.
  rest.waits.clear();
  for (double& line : rest.laps.lines) {
    line -= station;
  }
  if (plan.diagnostics.speed_profile) {
    rest.reference.speed = JoinedBy(plan.reference.speed, ahead, start_speed, speed.acceleration);
    rest.schedule_speed = JoinedBy(plan.schedule_speed, {station, station + open_loop_end},
                                   start_speed, speed.acceleration);
    return rest;
  }
  rest.reference.speed = StopAtEnd(rest.reference.path.length(), start_speed, speed, rest.caps);
  rest.schedule_speed = StopAtEnd(open_loop_end, start_speed, speed, rest.caps);
  return rest;
}

}  // namespace trackbed
