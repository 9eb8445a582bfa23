#pragma once

#include <optional>
#include <string>

#include "src/drive/standstill.h"
#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

/// Termination criteria of a run.
namespace trackbed {

/// Whether the car stands and is not commanded to move.
bool IsAtRest(const VehicleState& state, const Command& command);

/// State of a run at the beginning of a control period.
struct LoopStatus {
  const VehicleState& state;
  const Plant& plant;
  const Plan& segment;                   ///< the present segment
  bool is_last_segment = true;           ///< no segment follows
  bool interrupted = false;              ///< the caller asked to stop
  bool at_rest = false;                  ///< IsAtRest, and the steering is complete
  bool to_move = false;                  ///< the last command is to accelerate
  bool run_continues = false;            ///< at rest, but the run continues
  std::optional<double> contact_time{};  ///< first contact with an obstacle [s]
};

/// Ends a run when it has diverged or when the car sinks, is airborne, stuck or rolled over; when
/// interrupted; at the duration or time limit; a second after a collision; and, along a path, at
/// rest.
class Termination {
 public:
  /// `plan` is the initial plan of the run.
  Termination(const LoopConfig& config, const Plan& plan);

  /// The final status if the run has ended. Must be called once per control period.
  std::optional<DriveStatus> Update(const LoopStatus& now);

  /// Text for RunLog::cause if the run ended by a fault of the physics.
  [[nodiscard]] const std::string& cause() const { return cause_; }

  /// Latest end of the run known so far [s].
  [[nodiscard]] double end_time() const { return end_time_; }

 private:
  [[nodiscard]] DriveStatus StatusAtEnd(const LoopStatus& now) const;
  [[nodiscard]] bool HasArrived(const LoopStatus& now) const;
  /// Status of a fault of the physics; sets `cause_`.
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
  std::optional<double> airborne_since_;  // [s]
  Standstill standstill_;                 // despite a command to move
};

}  // namespace trackbed
