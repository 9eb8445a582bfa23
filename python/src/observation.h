#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "python/src/bindings.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/drive.h"
#include "trackbed/drive/stepped_loop.h"

namespace trackbed::python {

/// Value of a quantity that is not defined, for example without a path.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The input of a controller in a control period, with the tracking errors of the received pose.
struct Observation {
  VehicleState state;
  double station = 0.0;
  double plan_time = 0.0;
  double cross_track = kUnknown;
  double heading_error = kUnknown;
  double clearance = kUnknown;
  double curvature = kUnknown;
  double planned_speed = kUnknown;
  std::optional<DriveStatus> status;
};

/// One field of an observation.
struct Field {
  const char* name;
  double (*value)(const Observation&);
  const char* doc;
};

/// The fields of an observation, in the order of VectorLoop.columns.
inline constexpr auto kFields = std::to_array<Field>(
    {{"t_s", [](const Observation& o) { return o.state.time; }, "Time since the start [s]."},
     {"x_m", [](const Observation& o) { return o.state.pose.x; },
      "x of the rear-axle center [m], with measurement noise if the scenario has any."},
     {"y_m", [](const Observation& o) { return o.state.pose.y; },
      "y of the rear-axle center [m], with measurement noise if the scenario has any."},
     {"yaw_rad", [](const Observation& o) { return o.state.pose.yaw; },
      "Yaw [rad], positive to the left, not wrapped, with measurement noise."},
     {"speed_mps", [](const Observation& o) { return o.state.speed; },
      "Speed of the rear-axle center along x [m/s], negative backwards."},
     {"lateral_speed_mps", [](const Observation& o) { return o.state.lateral_speed; },
      "Speed along y of the ground point below the center of gravity [m/s]."},
     {"yaw_rate_radps", [](const Observation& o) { return o.state.yaw_rate; }, "Yaw rate [rad/s]."},
     {"roll_rad", [](const Observation& o) { return o.state.roll; },
      "Roll angle [rad], positive with the right side down."},
     {"pitch_rad", [](const Observation& o) { return o.state.pitch; },
      "Pitch angle [rad], positive with the nose down."},
     {"longitudinal_acceleration_mps2",
      [](const Observation& o) { return o.state.longitudinal_acceleration; },
      "Acceleration of the center of gravity along x [m/s^2]."},
     {"lateral_acceleration_mps2",
      [](const Observation& o) { return o.state.lateral_acceleration; },
      "Acceleration of the center of gravity along y [m/s^2]."},
     {"sideslip_rad", [](const Observation& o) { return o.state.sideslip; },
      "Sideslip angle at the center of gravity [rad]."},
     {"steering_actuator_rad", [](const Observation& o) { return o.state.steering_actuator; },
      "Angle of the rate-limited steering actuator [rad]."},
     {"steering_rad", [](const Observation& o) { return o.state.steering; },
      "Measured steering angle of the bicycle model [rad]."},
     {"distance_m", [](const Observation& o) { return o.state.distance; }, "Driven distance [m]."},
     {"station_m", [](const Observation& o) { return o.station; },
      "Station of the car on the present plan [m], as the scenario's controller receives it."},
     {"plan_time_s", [](const Observation& o) { return o.plan_time; },
      "Time since the present plan took effect [s]."},
     {"cross_track_m", [](const Observation& o) { return o.cross_track; },
      "Cross-track error [m], positive to the left of the path; NaN without a path."},
     {"heading_error_rad", [](const Observation& o) { return o.heading_error; },
      "Heading error [rad]; NaN without a path."},
     {"curvature_radpm", [](const Observation& o) { return o.curvature; },
      "Curvature of the path at station_m [1/m]; NaN without a path."},
     {"planned_speed_mps", [](const Observation& o) { return o.planned_speed; },
      "Planned speed at station_m [m/s], negative in reverse; NaN without a path."},
     {"clearance_m", [](const Observation& o) { return o.clearance; },
      "Smallest clearance from obstacles since the last observation [m]; NaN without obstacles."}});

/// Returns the observation of a loop that the caller steps.
Observation Observe(const SteppedLoop& loop);
/// Returns the observation of a controller. The clearance and the status are not known.
Observation Observe(const ControlInput& input);

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Reads the path, the speeds and the directions of a plan at `stations` [m].
py::dict ReferenceAt(const std::function<void(const std::function<void(const Reference&)>&)>& with,
                     const Numbers& stations);

void BindObservation(py::module_& module);

}  // namespace trackbed::python
