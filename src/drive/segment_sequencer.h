#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// Splits plans with stops, for a change of direction or for steering at standstill, into segments
/// that are driven one after the other.
namespace trackbed {

/// Splits a plan at its cusps and stops. At least one segment; the car stops only at its end.
std::deque<Plan> SplitIntoSegments(const Plan& plan);

/// Gear at the start of a plan: +1 forward, -1 reverse.
int PlanGear(const Plan& plan);

/// Holds a car at a cusp, or at a start on a bend, until its wheels reach their target; then the
/// gear changes.
class StationarySteer {
 public:
  void Begin();

  /// Must be called with the actuator's angle [rad] once per control period. Steering is complete
  /// when the angle stops changing.
  void Update(double steering);

  [[nodiscard]] bool InProgress() const { return in_progress_; }

 private:
  bool in_progress_ = false;
  double last_steering_ = std::numeric_limits<double>::infinity();  // at the last update [rad]
};

/// Tracks the present segment and the car's position on it.
///
/// Symbols: a station is the distance along the present segment; a station of the log also includes
/// all segments and plans driven before.
class SegmentSequencer {
 public:
  struct Options {
    StationSource station_source = StationSource::kProjection;
    VehicleParams vehicle{};      ///< only the wheelbase is used
    double control_period = 0.0;  ///< [s]
    double goal_tolerance = 0.0;  ///< a car at rest within this distance of the end has arrived [m]
  };

  /// `start` is the car's initial state. A car at rest at a start on a bend steers first.
  SegmentSequencer(const FeasiblePlan& plan, const VehicleState& start, const Options& options);

  [[nodiscard]] const Plan& plan() const { return plan_; }  ///< the present segment
  [[nodiscard]] bool has_path() const { return has_path_; }
  [[nodiscard]] bool is_last() const { return remaining_.empty(); }
  /// Station of the car's last projection [m].
  [[nodiscard]] double station() const { return station_; }
  /// Station of the log at which the segment begins [m].
  [[nodiscard]] double offset() const { return offset_; }
  /// Time at which the segment began [s].
  [[nodiscard]] double start_time() const { return start_time_; }
  /// Speed profile for the station returned by StationFor.
  [[nodiscard]] const SpeedProfile& speed() const;

  /// The station for the controller in `state`: the last projection, or the distance driven since
  /// the start of the segment [m].
  [[nodiscard]] double StationFor(const VehicleState& state) const;

  /// Projects the car onto the path near its last station. Returns its deviation from the path
  /// without extensions, with a station of the log. None without a path.
  std::optional<Projection> Project(const VehicleState& state);

  /// Station of a measured pose, near the last projection [m].
  [[nodiscard]] double StationNear(const Pose2& pose) const;

  /// Replaces the remaining plan by another one, which begins here.
  void Replace(const FeasiblePlan& plan, const VehicleState& state);

  /// Whether a car at rest is at the end of the segment: of the last one, within the goal tolerance
  /// of the goal or the end of the path; of any other one, where Advance leaves it.
  [[nodiscard]] bool IsAtEnd(const VehicleState& state) const;

  /// Begins the next segment, with steering at standstill, if a car at rest is at the end of the
  /// present one. Returns whether it did; the car must then be projected again.
  bool Advance(const VehicleState& state);

  [[nodiscard]] StationarySteer& stationary_steer() { return stationary_steer_; }
  [[nodiscard]] const StationarySteer& stationary_steer() const { return stationary_steer_; }

 private:
  void Begin(Plan plan, double offset, const VehicleState& state);

  Options options_;
  bool has_path_;
  std::deque<Plan> remaining_;
  Plan plan_;
  double offset_ = 0.0;          // station of the log at the segment's start [m]
  double start_distance_ = 0.0;  // odometer at the segment's start [m]
  double start_time_ = 0.0;      // [s]
  double station_ = 0.0;         // [m]
  StationarySteer stationary_steer_;
};

}  // namespace trackbed
