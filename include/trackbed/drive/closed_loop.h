#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/speed_controller.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/replan/replan.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/sim/plant.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

/// The closed loop of any plant, any steering controller and any plan.
namespace trackbed {

/// Callbacks to follow a run and to end it early. Each may be empty.
struct DriveHooks {
  std::function<void(double fraction)> progress{};  ///< called at most 100 times, with 0 to 1
  std::function<bool()> interrupted{};              ///< polled once per control period
  /// Called after each update of the steering with the wall-clock time that it took [s].
  std::function<void(double seconds)> steered{};
  /// Called with each row of the log, before the control period that it begins is simulated, and
  /// with the last one; the run waits for it. `log` has the rows and plan changes so far,
  /// `configurations` what RunLog::configurations will begin with.
  std::function<void(const RunLog& log, const Table& configurations)> logged{};
};

/// New plans during a run. Without `avoid` and `replan`, obstacles do not change the plan.
struct ReplanningConfig {
  std::optional<AvoiderOptions> avoid{};  ///< the local planner that reroutes around obstacles
  std::optional<ReplanOptions> replan{};  ///< periodic replanning along the route
  SpeedLimits limits{};                   ///< of the mission; all > 0
  /// Of new plans that ask more than the car and the road hold (feasibility.h).
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
};

/// The configuration of a run, except for its plant, controller and plan. Only `vehicle` must be
/// set. Holds values; only the hooks may hold references.
struct LoopConfig {
  VehicleParams vehicle{};  ///< of the plant; wheelbase, length and width > 0
  /// The vehicle as assumed by planners and controllers, such as without its payload. None:
  /// `vehicle`. For the controller, `disturbances.wheelbase` scales its wheelbase as well.
  std::optional<VehicleParams> nominal_vehicle{};
  /// Obstacles for clearance, collisions and replanning; friction for the hardest braking. Must be
  /// the world that the plant was made with.
  World world{};

  double timestep = 0.002;           ///< by which Plant::Step advances [s], > 0
  double control_period = 0.02;      ///< a whole number of timesteps [s]
  double state_period = 1.0 / 60.0;  ///< between logged configurations [s], > 0
  double time_limit = 600.0;         ///< simulated [s], > 0
  std::optional<double> duration{};  ///< ends the run [s], > 0; for plans without a path

  /// A vehicle at rest within this distance of Plan::goal has arrived; a fraction of its length, >=
  /// 0.
  double goal_tolerance = 0.1;
  /// The heading must also be within this of the goal's [rad], >= 0. None: the heading does not
  /// matter.
  std::optional<double> goal_heading_tolerance{};

  StationSource station_source = StationSource::kProjection;
  /// Sends the plan's steering schedule to the actuator at every timestep; the controller's output
  /// is only logged. Needs StationSource::kOdometer.
  bool follow_schedule = false;
  /// Must be that of the plant. With kPrescribed, the wheels reach the commanded angle on a ramp
  /// over the control period.
  SteeringInput steering_input = SteeringInput::kActuator;
  SpeedControlOptions speed{};

  /// Faults injected into the loop. `payload` and `recovered_within` are not used here: the plant
  /// has the payload, and recovery is measured after the run.
  Disturbances disturbances{};
  std::uint64_t seed = 0;  ///< of the measurement noise and of replanning
  std::optional<ReplanningConfig> replanning{};

  /// Names of the numbers of Plant::Configuration, as CarModel::configuration_columns. Empty:
  /// configurations are not logged.
  std::vector<std::string> configuration_columns{};
  DriveHooks hooks{};
};

/// Runs `controller` and the speed control on `plant` along `plan`. Once per control period:
/// observe; project onto the path; switch to a new plan or to the next forward or reverse segment
/// if due; end the run if it is over; steer and set the acceleration; log; step the plant.
///
/// `plant` must be at the start, not stepped yet, with the timestep, world and steering input of
/// `config`. Its start speed and actuator angle are those of the run; its odometer may have any
/// value. The log's times count from 0, and RunLog::plant is left empty. A plan without a path
/// (length 0) only sets the speed, until the duration or the time limit.
/// SteeringController::Accelerate overrides the plan's speeds; SpeedControlOptions::over_time and
/// ::braking override both.
///
/// A plan that changes direction is driven segment by segment: at rest at the end of a segment, the
/// wheels turn to the initial angle of the next, then the gear changes. A run along a path ends at
/// rest, unless a segment or a new plan is still to come; DriveStatus lists all other ends.
///
/// Guarantees: the same plant, controller, plan, configuration and build give the same log, bit for
/// bit. Changes no arguments other than plant and controller. Exceptions of plant, controller and
/// hooks pass through.
/// All plans come from MakeFeasible (feasibility.h), the initial one and those made during the run.
/// Does not check that MakeFeasible was given this vehicle and road, nor that the plant moves as
/// the vehicle's parameters say. Errors: PreconditionError for a plan that is not ok, or a
/// configuration value outside its documented range; the message names the value and the range, and
/// the plant is unchanged. PreconditionError also when the controller's output is not finite. Cost:
/// that of plant and controller, and 10 us and 0.5 kB of log per control period.
RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config);

}  // namespace trackbed
