#pragma once

#include <optional>
#include <string>

#include "src/drive/standstill.h"
#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

/// Criteria that end a run.
namespace trackbed {

/// Whether the car stands and is not commanded to move.
bool IsAtRest(const VehicleState& state, const Command& command);

/// State of a run at the beginning of a control period.
struct LoopStatus {
  const VehicleState& state;
  const Plant& plant;
  const Plan& segment;                   ///< Plan of the present segment.
  bool is_last_segment = true;           ///< No segment follows.
  bool interrupted = false;              ///< The caller asked to stop the run.
  bool at_rest = false;                  ///< IsAtRest is true and the steering is complete.
  bool to_move = false;                  ///< The last command is to accelerate.
  bool run_continues = false;            ///< The car is at rest, but the run continues.
  std::optional<double> contact_time{};  ///< Time of the first contact with an obstacle [s].
};

/// Ends a run if it has diverged or is interrupted, or if the car sinks, is airborne, stuck or
/// rolled over. The run also ends at the duration or time limit, a second after a collision and,
/// along a path, at rest.
class Termination {
 public:
  /// `plan` is the initial plan of the run.
  Termination(const LoopConfig& config, const Plan& plan);

  /// The final status of the run if it has ended. Update() must be called once per control period.
  std::optional<DriveStatus> Update(const LoopStatus& now);

  /// Text for RunLog::cause if the run ended by a fault of the physics.
  [[nodiscard]] const std::string& cause() const { return cause_; }

  /// Latest possible end of the run, as known so far [s].
  [[nodiscard]] double end_time() const { return end_time_; }

 private:
  [[nodiscard]] DriveStatus StatusAtEnd(const LoopStatus& now) const;
  [[nodiscard]] bool HasArrived(const LoopStatus& now) const;
  /// Status if the physics has a fault, in which case Fault sets `cause_`.
  std::optional<DriveStatus> Fault(const LoopStatus& now);

  bool has_path_;
  bool is_partial_;
  double goal_tolerance_;  // [m]
  std::optional<double> goal_heading_tolerance_;
  std::optional<double> duration_;
  double half_timestep_;
  double end_time_;
  double wheel_radius_;  // [m]
  std::string cause_;
  std::optional<double> airborne_since_;  // Time since which the car is airborne [s].
  Standstill standstill_;                 // Standstill of the car despite a command to move.
};

}  // namespace trackbed
