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

inline constexpr std::size_t kFieldCount = 22;
extern const std::array<Field, kFieldCount> kFields;

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
