#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// Splits plans at stops into segments that are driven one after the other. A plan contains a stop
/// where the direction of motion changes or the wheels steer at standstill.
namespace trackbed {

/// Splits a plan at its cusps and stops into at least one segment. Within a segment, the car does
/// not stop.
std::deque<Plan> SplitIntoSegments(const Plan& plan);

/// Returns the gear at the start of a plan: +1 forward, -1 reverse.
int PlanGear(const Plan& plan);

/// At a cusp, a stop, or a start on a bend, keeps the car at standstill until the wheels have
/// reached the target angle and a planned wait is over. At the end of the standstill, the gear
/// changes.
class StationarySteer {
 public:
  /// Begins a standstill that lasts at least until the time `until` [s].
  void Begin(double until);

  /// Ends the standstill when the actuator's angle `steering` [rad] stops changing, but not before
  /// the planned wait is over. The argument `time` is the time since the start of the run [s]. Call
  /// Update once per control period.
  void Update(double steering, double time);

  [[nodiscard]] bool InProgress() const { return in_progress_; }

 private:
  bool in_progress_ = false;
  double until_ = 0.0;  // Time at which the wait ends [s].
  // Steering angle of the actuator at the last update [rad].
  double last_steering_ = std::numeric_limits<double>::infinity();
};

/// Tracks the present segment of the plan and the car's position on this segment.
///
/// In SegmentSequencer, a station is the distance along the present segment. A station of the log
/// also includes the lengths of all segments and plans that the car drove before.
class SegmentSequencer {
 public:
  struct Options {
    StationSource station_source = StationSource::kProjection;
    VehicleParams vehicle{};      ///< Vehicle parameters; only the wheelbase is used.
    double control_period = 0.0;  ///< Control period [s].
    /// Maximum distance from the end of the segment at which a car at rest counts as arrived [m].
    double goal_tolerance = 0.0;
  };

  /// `start` is the initial state of the car. A car that starts at rest on a bend steers before it
  /// moves. A car that starts at rest waits if the plan begins with a wait.
  SegmentSequencer(const FeasiblePlan& plan, const VehicleState& start, const Options& options);

  [[nodiscard]] const Plan& plan() const { return plan_; }  ///< The plan of the present segment.
  [[nodiscard]] bool has_path() const { return has_path_; }
  [[nodiscard]] bool is_last() const { return remaining_.empty(); }
  /// Returns the station of the car's last projection [m].
  [[nodiscard]] double station() const { return station_; }
  /// Returns the station of the log at which the segment begins [m].
  [[nodiscard]] double offset() const { return offset_; }
  /// Returns the time at which the segment began, or at which the wait at its start ends [s].
  [[nodiscard]] double start_time() const { return start_time_; }
  /// Returns the speed profile of the present segment, a function of the station that StationFor
  /// returns.
  [[nodiscard]] const SpeedProfile& speed() const;

  /// Returns the station that the controller receives in `state` [m]. The controller's
  /// StationSource selects the station of the last projection or the distance driven since the
  /// start of the segment. At a standstill, the controller's station is at least 0. With a station
  /// of at least 0, a car that stands slightly before a bend steers for the bend, not for the
  /// straight extension of the path.
  [[nodiscard]] double StationFor(const VehicleState& state) const;

  /// Projects the car onto the path near the car's last station. Returns the station of the log and
  /// the car's deviation from the path without extensions, or nullopt without a path.
  std::optional<Projection> Project(const VehicleState& state);

  /// Returns the station of a measured pose [m], searched near the last projection. At a
  /// standstill, StationNear returns at least 0.
  [[nodiscard]] double StationNear(const Pose2& pose) const;

  /// Replaces the remaining plan by `plan`, which begins at the car's state.
  void Replace(const FeasiblePlan& plan, const VehicleState& state);

  /// Returns whether a car at rest is at the end of its segment. In the last segment, the car must
  /// be within the goal tolerance of the goal or of the path's end. In all earlier segments, the
  /// car's station must be within the goal tolerance of the segment's end, or in the second half of
  /// a short segment.
  [[nodiscard]] bool IsAtEnd(const VehicleState& state) const;

  /// If a car at rest is at the end of its segment, begins the next segment with steering at
  /// standstill. Advance returns true if a new segment began, onto whose path the caller must
  /// project the car.
  bool Advance(const VehicleState& state);

  [[nodiscard]] StationarySteer& stationary_steer() { return stationary_steer_; }
  [[nodiscard]] const StationarySteer& stationary_steer() const { return stationary_steer_; }

 private:
  void Begin(Plan plan, double offset, const VehicleState& state);
  /// Returns `station`, but at least 0 while the car steers at standstill.
  [[nodiscard]] double OnSegment(double station) const;
  /// Keeps the car at standstill for `wait` [s] from `time` [s] on, and until its wheels have
  /// turned.
  void BeginStandstill(double time, double wait);

  Options options_;
  bool has_path_;
  std::deque<Plan> remaining_;
  Plan plan_;
  double offset_ = 0.0;          // Station of the log at the segment's start [m].
  double start_distance_ = 0.0;  // Odometer reading at the start of the segment [m].
  double start_time_ = 0.0;      // Start time of the segment [s].
  double station_ = 0.0;         // Station of the car's last projection onto the path [m].
  StationarySteer stationary_steer_;
};

}  // namespace trackbed
