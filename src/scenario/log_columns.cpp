#include "trackbed/scenario/log_columns.h"

#include <fmt/format.h>

#include "trackbed/control/controllers.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

std::vector<std::string> LogColumns(const LogContents& contents) {
  std::vector<std::string> columns{"t_s",
                                   "x_m",
                                   "y_m",
                                   "yaw_rad",
                                   "speed_mps",
                                   "lateral_speed_mps",
                                   "yaw_rate_radps",
                                   "roll_rad",
                                   "pitch_rad",
                                   "longitudinal_acceleration_mps2",
                                   "lateral_acceleration_mps2",
                                   "sideslip_rad",
                                   "steering_command_rad",
                                   "steering_actuator_rad",
                                   "steering_rad",
                                   "s_m"};
  if (contents.path) {
    columns.insert(columns.end(), {"cross_track_m", "heading_error_rad"});
  }
  if (contents.obstacles) {
    columns.insert(columns.end(), {"clearance_m", "obstacle_force_N"});
  }
  if (contents.noise) {
    columns.insert(columns.end(), {"measured_x_m", "measured_y_m", "measured_yaw_rad"});
  }
  if (contents.wheels) {
    for (const char* wheel : kWheels) {
      for (const char* pattern :
           {"normal_force_{}_N", "longitudinal_force_{}_N", "lateral_force_{}_N",
            "slip_angle_{}_rad", "slip_ratio_{}", "friction_use_{}"}) {
        columns.push_back(fmt::format(fmt::runtime(pattern), wheel));
      }
    }
  }
  if (contents.abs) {
    for (const char* wheel : kWheels) {
      columns.push_back(fmt::format("abs_active_{}", wheel));
    }
  }
  if (contents.esc) {
    for (const char* wheel : kWheels) {
      columns.push_back(fmt::format("esc_brake_torque_{}_Nm", wheel));
    }
    columns.insert(columns.end(), {"yaw_rate_reference_radps", "esc_drive_share"});
  }
  if (contents.differential) {
    columns.emplace_back("differential_torque_Nm");
  }
  if (contents.trailer) {
    columns.insert(columns.end(), {"hitch_angle_rad", "hitch_rate_radps"});
  }
  if (contents.gaps) {
    columns.emplace_back("valid");
  }
  if (contents.origin) {
    columns.insert(columns.end(), kOriginColumns.begin(), kOriginColumns.end());
  }
  columns.insert(columns.end(), contents.controller.begin(), contents.controller.end());
  return columns;
}

std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant) {
  const bool recorded = plant == kRecordedPlant;
  const MeasurementNoise& noise = scenario.disturb.noise;
  const ControllerOptions& steering = scenario.control.steering;
  const bool wheels = !recorded && plant != "kinematic" && plant != "single_track";
  const AidOptions aids = wheels && scenario.vehicle.aids ? *scenario.vehicle.aids : AidOptions{};
  return LogColumns({.path = scenario.plan.has_value(),
                     .obstacles = HasObstacles(scenario.world),
                     .noise = !recorded && (noise.position > 0.0 || noise.heading > 0.0),
                     .wheels = wheels,
                     .abs = aids.abs,
                     .esc = aids.esc,
                     .differential = aids.differential != Differential::kOpen,
                     .trailer = !recorded && scenario.vehicle.trailer.has_value(),
                     .gaps = recorded,
                     .origin = OriginOf(scenario) != Vec2::Zero(),
                     .controller = recorded ? std::vector<std::string>{}
                                            : ControllerFor(steering).make(steering)->Columns()});
}

}  // namespace trackbed
