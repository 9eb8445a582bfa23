#include "src/drive/segment_sequencer.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/drive/path_tracking.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

namespace {

/// Returns the planned waits at the start of the station range `stretch`. The returned waits have
/// the station 0.
std::vector<PlannedWait> WaitsWithin(const Plan& plan, const Stations& stretch) {
  // Tolerance between the station of a planned wait and the station of its stop, as in
  // SplitIntoLegs [m].
  constexpr double kSameStation = 1e-9;
  std::vector<PlannedWait> waits;
  for (const PlannedWait& wait : plan.waits) {
    if (std::abs(wait.s - stretch.from) <= kSameStation) {
      waits.push_back({0.0, wait.duration});
    }
  }
  return waits;
}

/// Returns how long the car waits at the start of the plan [s].
double WaitAtStart(const Plan& plan) {
  double duration = 0.0;
  for (const PlannedWait& wait : WaitsWithin(plan, {0.0, 0.0})) {
    duration += wait.duration;
  }
  return duration;
}

}  // namespace

std::deque<Plan> SplitIntoSegments(const Plan& plan) {
  const std::vector<Stations> stretches = SplitIntoLegs(plan.reference.path, plan.stops);
  if (stretches.size() == 1) {
    return {plan};
  }
  std::deque<Plan> segments;
  for (const Stations& stretch : stretches) {
    Plan& own = segments.emplace_back(plan);
    own.stops.clear();
    own.waits = WaitsWithin(plan, stretch);
    own.reference = Excerpt(plan.reference, stretch);
    own.schedule_speed = Excerpt(plan.schedule_speed, stretch);
    own.schedule = plan.schedule.From(stretch.from);
  }
  return segments;
}

int PlanGear(const Plan& plan) {
  return plan.reference.path.At(0.0).direction;
}

void StationarySteer::Begin(double until) {
  in_progress_ = true;
  until_ = until;
  last_steering_ = std::numeric_limits<double>::infinity();
}

void StationarySteer::Update(double steering, double time) {
  // Steering change per control period below which the wheels are considered to be still [rad].
  constexpr double kMaxSteeringChange = 1e-4;
  const bool is_still = std::abs(steering - last_steering_) < kMaxSteeringChange;
  in_progress_ = in_progress_ && (!is_still || time < until_);
  last_steering_ = steering;
}

SegmentSequencer::SegmentSequencer(const FeasiblePlan& plan, const VehicleState& start,
                                   const Options& options)
    : options_(options),
      has_path_(plan->reference.path.length() > 0.0),
      remaining_(SplitIntoSegments(plan)),
      plan_(std::move(remaining_.front())),
      start_distance_(start.distance) {
  remaining_.pop_front();
  const double wait = WaitAtStart(plan_);
  if (has_path_ && start.speed == 0.0 &&
      (wait > 0.0 || plan_.reference.path.At(0.0).curvature != 0.0)) {
    BeginStandstill(start.time, wait);
  }
}

const SpeedProfile& SegmentSequencer::speed() const {
  return options_.station_source == StationSource::kOdometer ? plan_.schedule_speed
                                                             : plan_.reference.speed;
}

double SegmentSequencer::StationFor(const VehicleState& state) const {
  return options_.station_source == StationSource::kOdometer ? state.distance - start_distance_
                                                             : OnSegment(station_);
}

double SegmentSequencer::OnSegment(double station) const {
  return stationary_steer_.InProgress() ? std::max(station, 0.0) : station;
}

std::optional<Projection> SegmentSequencer::Project(const VehicleState& state) {
  if (!has_path_) {
    return std::nullopt;
  }
  const Path& path = plan_.reference.path;
  const double moved = std::abs(state.speed) * options_.control_period;
  const Projection extended =
      path.Project(state.pose, StationsAround(options_.vehicle, station_, moved));
  station_ = extended.s;
  Projection at =
      DistanceFromPath(path, extended, state.pose, is_last() ? options_.goal_tolerance : 0.0);
  at.s += offset_;
  return at;
}

double SegmentSequencer::StationNear(const Pose2& pose) const {
  return OnSegment(
      plan_.reference.path.Project(pose, StationsAround(options_.vehicle, station_, 0.0)).s);
}

void SegmentSequencer::Replace(const FeasiblePlan& plan, const VehicleState& state) {
  remaining_.clear();
  Begin(*plan, offset_ + station_, state);
}

bool SegmentSequencer::IsAtEnd(const VehicleState& state) const {
  const Path& path = plan_.reference.path;
  if (!has_path_) {
    return false;
  }
  if (!is_last()) {
    const double reach = std::min(options_.goal_tolerance, 0.5 * path.length());
    return StationFor(state) >= path.length() - reach;
  }
  // On a closed path, the start and the end are at the same place, so the car's station must also
  // be near the path's end. The factor pi/2 allows for curved paths: an arc of at most half a turn
  // is at most pi/2 times as long as its chord.
  const Vec2 place = state.pose.position();
  const double away = std::min((path.At(path.length()).pose.position() - place).norm(),
                               (plan_.goal.position() - place).norm());
  return away <= options_.goal_tolerance &&
         station_ >= path.length() - 0.5 * kPi * options_.goal_tolerance;
}

bool SegmentSequencer::Advance(const VehicleState& state) {
  if (is_last() || !IsAtEnd(state)) {
    return false;
  }
  const double length = plan_.reference.path.length();
  Plan next = std::move(remaining_.front());
  remaining_.pop_front();
  Begin(std::move(next), offset_ + length, state);
  BeginStandstill(state.time, WaitAtStart(plan_));
  return true;
}

void SegmentSequencer::BeginStandstill(double time, double wait) {
  start_time_ = time + wait;
  stationary_steer_.Begin(start_time_);
}

void SegmentSequencer::Begin(Plan plan, double offset, const VehicleState& state) {
  plan_ = std::move(plan);
  offset_ = offset;
  start_distance_ = state.distance;
  start_time_ = state.time;
  station_ = 0.0;
}

}  // namespace trackbed
