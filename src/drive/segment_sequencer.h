#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// Splits plans at stops into segments that are driven one after the other. A plan stops for a
/// change of direction or for steering at standstill.
namespace trackbed {

/// Splits a plan at its cusps and stops. SplitIntoSegments returns at least one segment, and the
/// car stops only at the end of a segment.
std::deque<Plan> SplitIntoSegments(const Plan& plan);

/// Gear at the start of a plan: +1 forward, -1 reverse.
int PlanGear(const Plan& plan);

/// Holds a car at a cusp, or at a start on a bend, until its wheels reach their target. The gear
/// changes once the wheels have reached their target.
class StationarySteer {
 public:
  void Begin();

  /// Update() must be called with the actuator's angle [rad] once per control period. Steering is
  /// complete when the angle stops changing.
  void Update(double steering);

  [[nodiscard]] bool InProgress() const { return in_progress_; }

 private:
  bool in_progress_ = false;
  double last_steering_ = std::numeric_limits<double>::infinity();  // actuator's angle at the last
                                                                    // update [rad]
};

/// Tracks the present segment and the car's position on it.
///
/// A station is the distance along the present segment. A station of the log also includes all
/// segments and plans driven before.
class SegmentSequencer {
 public:
  struct Options {
    StationSource station_source = StationSource::kProjection;
    VehicleParams vehicle{};      ///< Parameters of the vehicle, of which only the wheelbase is
                                  ///< used.
    double control_period = 0.0;  ///< Control period [s].
    double goal_tolerance = 0.0;  ///< A car at rest within this distance of the end has arrived
                                  ///< [m].
  };

  /// `start` is the initial state of the car. If the start is on a bend, a car at rest steers
  /// before it moves.
  SegmentSequencer(const FeasiblePlan& plan, const VehicleState& start, const Options& options);

  [[nodiscard]] const Plan& plan() const { return plan_; }  ///< The plan of the present segment.
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

  /// The station for the controller in `state` [m]. The station is that of the last projection or
  /// the distance driven since the start of the segment.
  [[nodiscard]] double StationFor(const VehicleState& state) const;

  /// Projects the car onto the path near the car's last station. The result is the car's deviation
  /// from the path without extensions, with a station of the log. Project() returns none without a
  /// path.
  std::optional<Projection> Project(const VehicleState& state);

  /// Station of a measured pose, near the last projection [m].
  [[nodiscard]] double StationNear(const Pose2& pose) const;

  /// Replaces the remaining plan by `plan`, which begins at the car's state.
  void Replace(const FeasiblePlan& plan, const VehicleState& state);

  /// Whether a car at rest is at the end of its segment. In the last segment, a car at the end is
  /// within the goal tolerance of the goal or of the path's end. In all segments but the last, a
  /// car is at the end if Advance leaves the segment.
  [[nodiscard]] bool IsAtEnd(const VehicleState& state) const;

  /// If a car at rest is at the end of its segment, begins the next segment with steering at
  /// standstill. Advance() returns whether a segment began; in that case the car must be projected
  /// again.
  bool Advance(const VehicleState& state);

  [[nodiscard]] StationarySteer& stationary_steer() { return stationary_steer_; }
  [[nodiscard]] const StationarySteer& stationary_steer() const { return stationary_steer_; }

 private:
  void Begin(Plan plan, double offset, const VehicleState& state);

  Options options_;
  bool has_path_;
  std::deque<Plan> remaining_;
  Plan plan_;
  double offset_ = 0.0;          // Station of the log at the segment's start [m].
  double start_distance_ = 0.0;  // Odometer at the start of the segment [m].
  double start_time_ = 0.0;      // Start time of the segment [s].
  double station_ = 0.0;         // Station of the last projection [m].
  StationarySteer stationary_steer_;
};

}  // namespace trackbed
