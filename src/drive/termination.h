#pragma once

#include <optional>
#include <string>

#include "src/drive/standstill.h"
#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

/// Criteria that end a run.
namespace trackbed {

/// Returns whether the car stands still and is not commanded to move.
bool IsAtRest(const VehicleState& state, const Command& command);

/// State of a run at the beginning of a control period.
struct LoopStatus {
  const VehicleState& state;
  const Plant& plant;
  const Plan& segment;          ///< Plan of the present segment.
  bool is_last_segment = true;  ///< Whether the present segment is the last segment of the run.
  bool interrupted = false;     ///< Whether the caller asked to end the run.
  bool at_rest = false;         ///< Whether the car rests and no longer steers.
  bool coasts = false;          ///< Whether the car coasts.
  bool to_move = false;         ///< Whether the last command accelerates the car.
  bool run_continues = false;   ///< Whether the run continues even if the car rests.
  std::optional<double> contact_time{};  ///< Time of the first contact with an obstacle [s].
};

/// Ends a run if the simulation diverged or was interrupted. Termination also ends the run if the
/// car sinks into the ground, is airborne, is stuck or rolled over, or if its trailer jackknifes or
/// rolls over. A run also ends at its time limit, at the end of its duration, and one second after
/// a collision. A run along a path also ends when the car is at rest. The run of a car that coasts
/// through a course with gates ends when the whole car has passed the last gate.
class Termination {
 public:
  /// `plan` is the initial plan of the run.
  Termination(const LoopConfig& config, const Plan& plan);

  /// Returns the final status if the run has ended, otherwise nullopt. Call Update once per control
  /// period.
  std::optional<DriveStatus> Update(const LoopStatus& now);

  /// Returns the text for RunLog::cause. The cause is empty unless a fault of the physics ended the
  /// run or the car stopped beside the goal.
  [[nodiscard]] const std::string& cause() const { return cause_; }

  /// Returns the latest time at which the run can end, as known so far [s].
  [[nodiscard]] double end_time() const { return end_time_; }

 private:
  /// Returns the status of a run that ends without a fault. Sets `cause_` if the car stopped beside
  /// the goal.
  DriveStatus StatusAtEnd(const LoopStatus& now);
  [[nodiscard]] bool HasArrived(const LoopStatus& now) const;
  /// Returns whether the car coasts and has passed the last gate of the course.
  [[nodiscard]] bool HasPassedCourse(const LoopStatus& now) const;
  /// Returns which tolerance of the goal the pose exceeds; empty if the pose is at the goal.
  [[nodiscard]] std::string GoalError(const Pose2& pose, const Pose2& goal) const;
  /// If a fault of the physics ends the run, sets `cause_` and returns the final status; otherwise
  /// returns nullopt.
  std::optional<DriveStatus> Fault(const LoopStatus& now);

  bool has_path_;
  bool is_partial_;
  double goal_tolerance_;  // [m]
  std::optional<double> goal_heading_tolerance_;
  std::optional<double> duration_;
  double half_timestep_;
  double end_time_;
  double wheel_radius_;  // [m]
  VehicleParams vehicle_;
  double jackknife_angle_;  // JackknifeAngle of the trailer; infinite without a trailer [rad].
  std::optional<Gate> last_gate_;
  std::string cause_;
  std::optional<double> airborne_since_;  // Time since which the car is airborne [s].
  Standstill standstill_;  // Measures how long the car stands still despite a command to move.
};

}  // namespace trackbed
