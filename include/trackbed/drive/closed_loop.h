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
  /// Called at most 100 times, with the fraction from 0 to 1.
  std::function<void(double fraction)> progress{};
  std::function<bool()> interrupted{};  ///< Whether to stop; called once per control period.
  /// Called after each update of the steering with the wall-clock time that it took [s].
  std::function<void(double seconds)> steered{};
  /// Called with each new row of the log, before its control period is simulated, and with the last
  /// row. The run waits for the callback. `log` has the rows and plan changes so far,
  /// `configurations` the configurations logged so far.
  std::function<void(const RunLog& log, const Table& configurations)> logged{};
};

/// New plans during a run. Without both `avoid` and `replan`, obstacles do not change the plan.
struct ReplanningConfig {
  std::optional<AvoiderOptions> avoid{};  ///< The local planner that reroutes around obstacles.
  std::optional<ReplanOptions> replan{};  ///< Options of periodic replanning along the route.
  SpeedLimits limits{};                   ///< Limits of the mission; all > 0.
  /// Policy for new plans that exceed the limits of car and road (feasibility.h).
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
};

/// The configuration of a run, except for its plant, controller and plan. Only `vehicle` must be
/// set. The configuration holds values; only the hooks may hold references.
struct LoopConfig {
  VehicleParams vehicle{};  ///< Parameters of the plant; wheelbase, length and width > 0.
  /// The vehicle that planners and controllers assume, for example without its payload; by default
  /// `vehicle`. For the controller, `disturbances.wheelbase` also scales its wheelbase.
  std::optional<VehicleParams> nominal_vehicle{};
  /// The world of the plant. The obstacles of the world determine clearance, collisions and
  /// replanning; its friction determines the hardest braking.
  World world{};

  double timestep = 0.002;           ///< Timestep of Plant::Step [s], > 0.
  double control_period = 0.02;      ///< Control period, a whole number of timesteps [s].
  double state_period = 1.0 / 60.0;  ///< Time between logged configurations [s], > 0.
  double time_limit = 600.0;         ///< Limit on the simulated time [s], > 0.
  std::optional<double> duration{};  ///< End of the run [s], > 0; for plans without a path.

  /// Distance from Plan::goal within which a vehicle at rest has arrived, as a fraction of its
  /// length, >= 0.
  double goal_tolerance = 0.1;
  /// Largest heading error at the goal for an arrival [rad], >= 0; nullopt if any heading is
  /// accepted.
  std::optional<double> goal_heading_tolerance{};

  StationSource station_source = StationSource::kProjection;
  /// Whether to send the plan's steering schedule to the actuator at every timestep. The
  /// controller's output is then only logged. Needs StationSource::kOdometer.
  bool follow_schedule = false;
  /// Steering input, which must be that of the plant. With kPrescribed, the wheels reach the
  /// commanded angle on a ramp over the control period.
  SteeringInput steering_input = SteeringInput::kActuator;
  SpeedControlOptions speed{};

  /// Faults injected into the loop. The loop ignores `payload`, which the plant contains, and
  /// `recovered_within`, which is used after the run.
  Disturbances disturbances{};
  std::uint64_t seed = 0;  ///< Seed of the measurement noise and of replanning.
  std::optional<ReplanningConfig> replanning{};

  /// Names of the numbers of Plant::Configuration, as in CarModel::configuration_columns. If the
  /// list is empty, configurations are not logged.
  std::vector<std::string> configuration_columns{};
  DriveHooks hooks{};
};

/// Runs `controller` and the speed control on `plant` along `plan`. The steps of each control
/// period: observe the plant; project its pose onto the path; switch to a new plan or to the next
/// forward or reverse segment if due; end the run if it is over; steer and set the acceleration;
/// log; step the plant.
///
/// `plant` must not have been stepped yet, and must have the timestep, world and steering input of
/// `config`. The run starts at the plant's speed and actuator angle; the odometer may have any
/// value. The times of the log count from 0, and RunLog::plant is left empty. A plan without a path
/// (length 0) only sets the speed, until the duration or the time limit.
/// SteeringController::Accelerate overrides the plan's speeds; SpeedControlOptions::over_time and
/// ::braking override both.
///
/// A plan that changes direction is driven segment by segment. At rest at the end of a segment, the
/// wheels turn to the initial angle of the next segment, then the gear changes. A run along a path
/// ends at rest, unless a segment or a new plan is still to come; DriveStatus lists all other ends.
///
/// Guarantees: the same plant, controller, plan, configuration and build give the same log, bit for
/// bit. Only the arguments `plant` and `controller` change. Exceptions of plant, controller and
/// hooks are not caught. Both the initial plan and the plans made during the run come from
/// MakeFeasible (feasibility.h). The function does not check that MakeFeasible used this vehicle
/// and road, nor that the plant matches the vehicle's parameters. Errors: PreconditionError for a
/// plan that is not ok, for a configuration value outside its documented range, and for a
/// controller output that is not finite. The message about a configuration names the value and the
/// range, and the plant is unchanged. Cost: that of plant and controller, plus 10 us and 0.5 kB of
/// log per control period.
RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config);

}  // namespace trackbed
