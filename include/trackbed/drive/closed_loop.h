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
#include "trackbed/vehicle/trailer.h"
#include "trackbed/world/world.h"

/// The closed loop of a plant, a steering controller and a plan.
namespace trackbed {

/// Callbacks to follow a run or to end it early. Any of the run's callbacks may be empty.
struct DriveHooks {
  /// Reports the progress of the run; called at most 100 times, with the completed fraction from 0
  /// to 1.
  std::function<void(double fraction)> progress{};
  /// Returns true to end the run early; called once per control period.
  std::function<bool()> interrupted{};
  /// Receives the wall-clock duration of each call of the steering controller [s], after the call.
  std::function<void(double seconds)> steered{};
  /// Receives the log after each new row, and also after the last row. The log callback is called
  /// before the loop simulates the control period that starts at the new row. The run waits until
  /// the log callback returns. `log` contains all rows and plan changes so far, and
  /// `configurations` contains all configurations logged so far.
  std::function<void(const RunLog& log, const Table& configurations)> logged{};
};

/// Options of replanning during a run. If neither `avoid` nor `replan` is set, the car keeps its
/// first plan regardless of obstacles.
struct ReplanningConfig {
  std::optional<AvoiderOptions> avoid{};  ///< Local planner that reroutes around obstacles.
  std::optional<ReplanOptions> replan{};  ///< Options of periodic replanning along the route.
  SpeedLimits limits{};                   ///< Speed and acceleration limits of the mission; all >
                                          ///< 0.
  /// What to do with new plans that exceed the limits of the car or the road (feasibility.h).
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
};

/// The configuration of a run, except for the plant, controller and plan of the run. All members of
/// LoopConfig except `vehicle` have usable defaults. A LoopConfig does not refer to other objects,
/// except for objects that the hooks use.
struct LoopConfig {
  /// Vehicle parameters of the plant; wheelbase, length and width must be > 0.
  VehicleParams vehicle{};
  /// The vehicle parameters that planners and controllers assume, for example without the payload;
  /// by default `vehicle`. The wheelbase that the controller assumes is also scaled by
  /// `disturbances.wheelbase`.
  std::optional<VehicleParams> nominal_vehicle{};
  std::optional<TrailerParams> trailer{};  ///< The trailer of the plant; nullopt: no trailer.
  /// The world in which the plant drives. The world's obstacles determine clearance, collisions and
  /// replanning. The world's friction coefficient limits the deceleration in the hardest braking.
  World world{};

  double timestep = 0.002;  ///< Timestep of Plant::Step [s], > 0.
  /// Time between two updates of the controller, a whole number of timesteps [s].
  double control_period = 0.02;
  /// Time between two logged configurations of the car [s], > 0.
  double state_period = 1.0 / 60.0;
  double time_limit = 600.0;         ///< Simulated time after which the run is ended [s], > 0.
  std::optional<double> duration{};  ///< Duration of a run whose plan has no path [s], > 0.

  /// Maximum distance from a vehicle at rest to Plan::goal at which the vehicle counts as arrived,
  /// as a fraction of the vehicle's length, >= 0.
  double goal_tolerance = 0.1;
  /// Maximum heading error at which a vehicle at the goal counts as arrived [rad], >= 0; nullopt if
  /// any heading is accepted.
  std::optional<double> goal_heading_tolerance{};

  StationSource station_source = StationSource::kProjection;
  /// Whether to send the plan's steering schedule to the actuator at every timestep. If
  /// `follow_schedule` is true, the controller's output is only logged, and the controller must use
  /// StationSource::kOdometer.
  bool follow_schedule = false;
  /// Type of the steering input; must equal the type that the plant uses. With kPrescribed, the
  /// angle of the wheels changes linearly during a control period and reaches the commanded angle
  /// at the end of the period.
  SteeringInput steering_input = SteeringInput::kActuator;
  SpeedControlOptions speed{};
  /// Station from which the car coasts [m], unless `speed.braking` has begun; nullopt: the car does
  /// not coast. If the car coasts, the run ends as kArrived when the whole car has passed the last
  /// gate of its plan.
  std::optional<double> coasts_from{};

  /// Disturbances and faults of the run, which the loop applies to the plant and the controller.
  /// The loop ignores the payload of the disturbances, because the plant's model already includes
  /// the payload. The loop also ignores `recovered_within`, a criterion for evaluating a finished
  /// run.
  Disturbances disturbances{};
  std::uint64_t seed = 0;  ///< Random seed of the measurement noise and of replanning.
  std::optional<ReplanningConfig> replanning{};

  /// Column names for the values of Plant::Configuration; see CarModel::configuration_columns. If
  /// the list of column names is empty, the loop does not log the plant's configurations.
  std::vector<std::string> configuration_columns{};
  DriveHooks hooks{};
};

/// Simulates the car `plant` driving along `plan`, controlled by `controller` and the speed
/// controller. In each control period, the loop first reads the state of the plant, and projects
/// the plant's pose onto the path. If a new plan or the next forward or reverse segment is due, the
/// loop switches to this plan or segment. After reading the plant's state, the loop ends the run if
/// an end criterion is met. If the run continues, the loop computes steering and acceleration, logs
/// a row, and simulates the plant until the next control period.
///
/// `plant` must not have simulated any steps yet, and must have the timestep, world and steering
/// input of `config`. The run starts at the plant's present speed and actuator angle; the odometer
/// may have any value. The times of the log start at 0, and RunLog::plant is left empty. A plan
/// without a path (length 0) only sets the speed; the run then ends after `duration` or
/// `time_limit`. If SteeringController::Accelerate returns an acceleration, this acceleration
/// overrides the speeds of the plan. SpeedControlOptions::over_time and
/// SpeedControlOptions::braking override both the plan's speeds and the acceleration from the
/// controller.
///
/// A plan that alternates between forward and reverse motion is driven segment by segment. While
/// the car is at rest at the end of a segment, the wheels turn to the initial angle of the next
/// segment; then the gear changes. A run along a path ends when the car is at rest, unless another
/// segment or a new plan follows. DriveStatus lists all ways in which a run can end.
///
/// Guarantees: the same plant, controller, plan, configuration and build always produce the same
/// log, bit for bit. SimulateClosedLoop modifies only the arguments `plant` and `controller`.
/// Exceptions thrown by the plant, the controller or the hooks propagate to the caller. The initial
/// plan and all plans made during the run have passed MakeFeasible (feasibility.h).
/// SimulateClosedLoop does not check whether MakeFeasible used the same vehicle and road, nor
/// whether the plant has the vehicle parameters of `config`. Throws PreconditionError for a plan
/// that is not ok, for a configuration value outside of the documented range, and for a controller
/// output that is not finite. For a wrong configuration value, the error message names the value
/// and the range, and the plant is unchanged. Each control period takes 10 us and 0.5 kB of log, in
/// addition to the cost of the plant and the controller.
RunLog SimulateClosedLoop(Plant& plant, SteeringController& controller, const FeasiblePlan& plan,
                          const LoopConfig& config);

}  // namespace trackbed
