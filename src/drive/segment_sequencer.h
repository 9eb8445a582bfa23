#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

/// Plans that stop on the way, to change direction or to turn the wheels, driven segment by
/// segment.
namespace trackbed {

/// A plan cut at its cusps and stops: the stretches that are driven in one go each, at least one.
std::deque<Plan> SplitIntoSegments(const Plan& plan);

/// +1 for a plan that begins forwards, -1 backwards.
int PlanGear(const Plan& plan);

/// Holds a car at a cusp, or at a start on a bend, until its wheels have turned to where they are
/// to be; then it changes gear.
class StationarySteer {
 public:
  void Begin();

  /// Takes the actuator's angle [rad], once per control period: the steering is over when the
  /// wheels rest.
  void Update(double steering);

  [[nodiscard]] bool InProgress() const { return in_progress_; }

 private:
  bool in_progress_ = false;
  double before_ = std::numeric_limits<double>::infinity();  // at the last update [rad]
};

/// Which segment is driven, and where the car is on it.
///
/// Symbols: a station is a distance along the segment that is driven; one of the log counts on over
/// all segments and plans that were driven before.
class SegmentSequencer {
 public:
  struct Options {
    StationSource station_source = StationSource::kProjection;
    VehicleParams vehicle{};      ///< the wheelbase counts
    double control_period = 0.0;  ///< [s]
    double goal_tolerance = 0.0;  ///< a car at rest this near the end is there [m]
  };

  /// `start` is the car before the first step. One at rest at a start on a bend steers first.
  SegmentSequencer(const Plan& plan, const VehicleState& start, const Options& options);

  [[nodiscard]] const Plan& plan() const { return plan_; }  ///< the segment
  [[nodiscard]] bool has_path() const { return has_path_; }
  [[nodiscard]] bool is_last() const { return remaining_.empty(); }
  /// Of the car on the segment, as it was last projected [m].
  [[nodiscard]] double station() const { return station_; }
  /// Of the log, where the segment begins [m].
  [[nodiscard]] double offset() const { return offset_; }
  /// When the segment was begun [s].
  [[nodiscard]] double start_time() const { return start_time_; }
  /// The speeds for the station that StationFor gives.
  [[nodiscard]] const SpeedProfile& speed() const;

  /// What a controller is told for `state`: the last projection, or the distance driven since the
  /// segment was begun [m].
  [[nodiscard]] double StationFor(const VehicleState& state) const;

  /// Projects the car onto the path near where it was. The result is that against the path as it
  /// is, without extensions, its station that of the log. None without a path.
  std::optional<Projection> Project(const VehicleState& state);

  /// Where a pose that was measured is [m], near the last projection.
  [[nodiscard]] double StationNear(const Pose2& pose) const;

  /// Drives another plan from here on, instead of everything that was left.
  void Replace(Plan plan, const VehicleState& state);

  /// Begins the next segment if a car at rest is at the end of this one, and steers for it. Whether
  /// it did: the car is to be projected anew.
  bool Advance(const VehicleState& state);

  [[nodiscard]] StationarySteer& stationary_steer() { return stationary_steer_; }
  [[nodiscard]] const StationarySteer& stationary_steer() const { return stationary_steer_; }

 private:
  void Begin(Plan plan, double offset, const VehicleState& state);

  Options options_;
  bool has_path_;
  std::deque<Plan> remaining_;
  Plan plan_;
  double offset_ = 0.0;          // [m]
  double start_distance_ = 0.0;  // odometer where the segment begins [m]
  double start_time_ = 0.0;      // [s]
  double station_ = 0.0;         // [m]
  StationarySteer stationary_steer_;
};

}  // namespace trackbed
