#include "src/drive/loop_preconditions.h"

#include <cmath>

#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

void CheckPositive(const char* name, double value) {
  TRACKBED_REQUIRE(value > 0.0 && std::isfinite(value),
                   "SimulateClosedLoop: {} is {}; must be finite and above 0", name, value);
}

void CheckNonNegative(const char* name, double value) {
  TRACKBED_REQUIRE(value >= 0.0 && std::isfinite(value),
                   "SimulateClosedLoop: {} is {}; must be finite and at least 0", name, value);
}

void CheckVehicle(const LoopConfig& config) {
  CheckPositive("LoopConfig::vehicle.wheelbase", config.vehicle.wheelbase);
  CheckPositive("LoopConfig::vehicle.length", config.vehicle.length);
  CheckPositive("LoopConfig::vehicle.width", config.vehicle.width);
  if (config.nominal_vehicle) {
    CheckPositive("LoopConfig::nominal_vehicle.wheelbase", config.nominal_vehicle->wheelbase);
    CheckPositive("LoopConfig::nominal_vehicle.length", config.nominal_vehicle->length);
    CheckPositive("LoopConfig::nominal_vehicle.width", config.nominal_vehicle->width);
  }
}

void CheckTimes(const LoopConfig& config) {
  CheckPositive("LoopConfig::timestep", config.timestep);
  const double steps = config.control_period / config.timestep;
  TRACKBED_REQUIRE(std::abs(steps - std::round(steps)) <= 1e-6 && steps >= 0.5,
                   "SimulateClosedLoop: LoopConfig::control_period is {} s; must be a whole number "
                   "of timesteps of {} s",
                   config.control_period, config.timestep);
  CheckPositive("LoopConfig::state_period", config.state_period);
  CheckPositive("LoopConfig::time_limit", config.time_limit);
  if (config.duration) {
    CheckPositive("LoopConfig::duration", *config.duration);
  }
}

void CheckControl(const LoopConfig& config) {
  CheckNonNegative("LoopConfig::goal_tolerance", config.goal_tolerance);
  if (config.goal_heading_tolerance) {
    CheckNonNegative("LoopConfig::goal_heading_tolerance", *config.goal_heading_tolerance);
  }
  CheckPositive("LoopConfig::speed.acceleration", config.speed.acceleration);
  CheckPositive("LoopConfig::speed.deceleration", config.speed.deceleration);
  CheckNonNegative("LoopConfig::speed.gain", config.speed.gain);
  TRACKBED_REQUIRE(
      !config.follow_schedule || config.station_source == StationSource::kOdometer,
      "SimulateClosedLoop: LoopConfig::follow_schedule needs station_source kOdometer");
}

void CheckDisturbances(const Disturbances& disturbances) {
  CheckPositive("LoopConfig::disturbances.wheelbase", disturbances.wheelbase);
  CheckPositive("LoopConfig::disturbances.steering.factor", disturbances.steering.factor);
  CheckNonNegative("LoopConfig::disturbances.steering.delay", disturbances.steering.delay);
  CheckNonNegative("LoopConfig::disturbances.steering.backlash", disturbances.steering.backlash);
  CheckNonNegative("LoopConfig::disturbances.noise.position", disturbances.noise.position);
  CheckNonNegative("LoopConfig::disturbances.noise.heading", disturbances.noise.heading);
}

void CheckReplanning(const ReplanningConfig& replanning, const Plan& plan) {
  if (!replanning.avoid && !replanning.replan) {
    return;
  }
  CheckPositive("ReplanningConfig::limits.speed", replanning.limits.speed);
  CheckPositive("ReplanningConfig::limits.acceleration", replanning.limits.acceleration);
  CheckPositive("ReplanningConfig::limits.deceleration", replanning.limits.deceleration);
  TRACKBED_REQUIRE(plan.reference.path.length() > 0.0,
                   "SimulateClosedLoop: the plan has no path; LoopConfig::replanning needs one");
  if (replanning.replan) {
    CheckPositive("ReplanningConfig::replan.period", replanning.replan->period);
    TRACKBED_REQUIRE(replanning.replan->along || replanning.replan->detour,
                     "SimulateClosedLoop: ReplanningConfig::replan has neither `along` nor "
                     "`detour`; it needs at least one");
  }
}

}  // namespace

void CheckLoopArguments(const Plant& plant, const Plan& plan, const LoopConfig& config) {
  TRACKBED_REQUIRE(plan.ok(), "SimulateClosedLoop: the plan's status is {} ({}); must be ok",
                   ToString(plan.status), plan.reason);
  CheckVehicle(config);
  CheckTimes(config);
  CheckControl(config);
  CheckDisturbances(config.disturbances);
  if (config.replanning) {
    CheckReplanning(*config.replanning, plan);
  }
  if (!config.configuration_columns.empty()) {
    const std::size_t columns = config.configuration_columns.size();
    const std::size_t numbers = plant.Configuration().size();
    TRACKBED_REQUIRE(columns == numbers,
                     "SimulateClosedLoop: LoopConfig::configuration_columns has {} names; the "
                     "plant's configuration has {} numbers",
                     columns, numbers);
  }
}

}  // namespace trackbed
