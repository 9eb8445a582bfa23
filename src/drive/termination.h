#pragma once

#include <optional>
#include <string>

#include "trackbed/drive/closed_loop.h"
#include "trackbed/planning/common/plan.h"

/// When a run is over, and how it ended.
namespace trackbed {

/// Whether the car stands, and was not asked to move.
bool IsAtRest(const VehicleState& state, const Command& command);

/// What is known of a run at the beginning of a control period.
struct LoopStatus {
  const VehicleState& state;
  const Plant& plant;
  const Plan& segment;                   ///< that is driven
  bool is_last_segment = true;           ///< nothing follows it
  bool interrupted = false;              ///< the caller asked to stop
  bool at_rest = false;                  ///< IsAtRest, and it did not steer on the spot
  bool to_move = false;                  ///< the last command asks for it
  bool will_go_on = false;               ///< at rest, but not for good
  std::optional<double> contact_time{};  ///< first contact with an obstacle [s]
};

/// Ends a run: once diverged, sunk, airborne, stuck or rolled over; when interrupted, after the
/// duration or time limit, a second after a collision; and along a path, at rest.
class Termination {
 public:
  /// `plan` is the one that the run begins with.
  Termination(const LoopConfig& config, const Plan& plan);

  /// How the run ended, if it is over. Asked once per control period.
  std::optional<DriveStatus> Update(const LoopStatus& now);

  /// Why, if the physics ended it: RunLog::cause.
  [[nodiscard]] const std::string& cause() const { return cause_; }

  /// When it ends at the latest, as far as is known [s].
  [[nodiscard]] double end_time() const { return end_time_; }

 private:
  [[nodiscard]] DriveStatus StatusAtEnd(const LoopStatus& now) const;
  [[nodiscard]] bool HasArrived(const LoopStatus& now) const;
  /// A fault of the physics, with `cause_`.
  std::optional<DriveStatus> Fault(const LoopStatus& now);
  [[nodiscard]] bool IsStuck(const LoopStatus& now);

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
  struct Moment {
    double time = 0.0;  // [s]
    Vec2 place;         // [m]
  };
  std::optional<Moment> still_since_;  // although it was to move
};

}  // namespace trackbed
