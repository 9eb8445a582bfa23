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

/// The closed loop of a plant, a steering controller and a plan.
namespace trackbed {

/// Callbacks to follow a run or to end it early. Each callback may be empty.
struct DriveHooks {
  /// Called at most 100 times, with the completed fraction of the run from 0 to 1.
  std::function<void(double fraction)> progress{};
  std::function<bool()> interrupted{};  ///< Returns whether to end the run early; called once per
                                        ///< control period.
  /// Called after each steering update with the wall-clock duration of the update [s].
  std::function<void(double seconds)> steered{};
  /// Called after each new row of the log, before the row's control period is simulated, and after
  /// the last row. The run waits for the callback. `log` contains all rows and plan changes so far,
  /// and `configurations` contains all configurations logged so far.
  std::function<void(const RunLog& log, const Table& configurations)> logged{};
};

/// Configuration of replanning during a run. If neither `avoid` nor `replan` is set, obstacles do
/// not change the plan.
struct ReplanningConfig {
  std::optional<AvoiderOptions> avoid{};  ///< The local planner that reroutes around obstacles.
  std::optional<ReplanOptions> replan{};  ///< Options of periodic replanning along the route.
  SpeedLimits limits{};                   ///< Speed and acceleration limits of the mission; all >
                                          ///< 0.
  /// Policy for new plans that exceed the limits of car and road (feasibility.h).
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
};

/// The configuration of a run, except for its plant, controller and plan. Only `vehicle` must be
/// set. The struct contains values, so it depends on no other objects; only the hooks may refer to
/// other objects.
struct LoopConfig {
  VehicleParams vehicle{};  ///< Parameters of the plant; wheelbase, length and width > 0.
  /// The vehicle parameters that planners and controllers assume, for example without the payload;
  /// by default `vehicle`. For the controller, the wheelbase is also scaled by
  /// `disturbances.wheelbase`.
  std::optional<VehicleParams> nominal_vehicle{};
  /// The world of the plant. The world's obstacles determine clearance, collisions and replanning.
  /// The world's friction determines the hardest braking.
  World world{};

  double timestep = 0.002;           ///< Timestep of Plant::Step [s], > 0.
  double control_period = 0.02;      ///< Control period, a whole number of timesteps [s].
  double state_period = 1.0 / 60.0;  ///< Time between logged configurations [s], > 0.
  double time_limit = 600.0;         ///< Limit on the simulated time [s], > 0.
  std::optional<double> duration{};  ///< Time at which a run whose plan has no path ends [s], > 0.

  /// Largest distance from Plan::goal at which a vehicle at rest has arrived, as a fraction of the
  /// vehicle's length, >= 0.
  double goal_tolerance = 0.1;
  /// Largest heading error at which a vehicle at the goal has arrived [rad], >= 0; nullopt accepts
  /// any heading.
  std::optional<double> goal_heading_tolerance{};

  StationSource station_source = StationSource::kProjection;
  /// Whether to send the plan's steering schedule to the actuator at every timestep. If true, the
  /// controller's output is only logged, and the controller must use StationSource::kOdometer.
  bool follow_schedule = false;
  /// Type of the steering input; must be that of the plant. With kPrescribed, the angle of the
  /// wheels changes linearly over the control period, to the commanded angle at its end.
  SteeringInput steering_input = SteeringInput::kActuator;
  SpeedControlOptions speed{};

  /// Faults injected into the loop. The loop ignores the payload, because the plant already
  /// includes it. The loop also ignores `recovered_within`, a criterion for evaluating the run
  /// afterwards.
  Disturbances disturbances{};
  std::uint64_t seed = 0;  ///< Seed of the measurement noise and of replanning.
  std::optional<ReplanningConfig> replanning{};

  /// Column names for the values of Plant::Configuration, as in CarModel::configuration_columns. If
  /// the list is empty, the loop logs no configurations.
  std::vector<std::string> configuration_columns{};
  DriveHooks hooks{};
};

/// Drives `plant` along `plan` by `controller` and the speed control. Each control period has these
/// steps: observe the plant; project its pose onto the path; switch to a new plan or to the next
/// forward or reverse segment if one is due; end the run if an end criterion is met; compute
/// steering and acceleration; log a row; step the plant.
///
/// `plant` must not have been stepped yet, and must have the timestep, world and steering input of
/// `config`. The run starts at the plant's speed and actuator angle; the odometer may have any
/// value. The times of the log start at 0, and RunLog::plant is left empty. A plan without a path
/// (length 0) only sets the speed, until `duration` or `time_limit` is over. An acceleration from
/// SteeringController::Accelerate overrides the plan's speeds. SpeedControlOptions::over_time and
/// SpeedControlOptions::braking override both.
///
/// A plan that changes direction is driven segment by segment. While the car is at rest at the end
/// of a segment, the wheels turn to the initial angle of the next segment; then the gear changes. A
/// run along a path ends when the car is at rest, unless a segment or a new plan is still to come.
/// DriveStatus lists the other ways in which a run can end.
///
/// Guarantees: the same plant, controller, plan, configuration and build give the same log, bit for
/// bit. SimulateClosedLoop modifies only the arguments `plant` and `controller`. Exceptions of
/// plant, controller and hooks propagate to the caller. Both the initial plan and the plans made
/// during the run come from MakeFeasible (feasibility.h). SimulateClosedLoop does not check that
/// MakeFeasible used this vehicle and road, nor that the plant matches the vehicle's parameters.
/// Errors: throws PreconditionError for a plan that is not ok, for a configuration value outside
/// its documented range, and for a controller output that is not finite. For a wrong configuration
/// value, the message names the value and the range, and the plant is unchanged. Cost per control
/// period: 10 us and 0.5 kB of log, in addition to the cost of plant and controller.
RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config);

}  // namespace trackbed
