#include "python/src/observation.h"

#include <algorithm>
#include <string>
#include <vector>

namespace trackbed::python {

Observation Observe(const ControlInput& input) {
  Observation seen{
      .state = input.state, .station = input.station, .plan_time = input.plan_time, .status = {}};
  const Path& path = input.reference.path;
  if (path.length() > 0.0) {
    const double station = std::max(0.0, input.station);
    const Projection at = path.Project(input.state.pose, {station, station});
    const PathBend point = path.BendAt(input.station);
    seen.cross_track = at.cross_track;
    seen.heading_error = at.heading_error;
    seen.curvature = point.curvature;
    seen.planned_speed = point.direction * input.reference.speed.SpeedAt(input.station);
  }
  return seen;
}

Observation Observe(const SteppedLoop& loop) {
  const ControlInput input = loop.input();
  const LogRow& row = loop.row();
  Observation seen{.state = input.state,
                   .station = input.station,
                   .plan_time = input.plan_time,
                   .clearance = row.clearance.value_or(kUnknown),
                   .status = loop.status()};
  if (row.tracking) {
    const PathBend at = input.reference.path.BendAt(input.station);
    seen.cross_track = row.tracking->cross_track;
    seen.heading_error = row.tracking->heading_error;
    if (row.measured) {
      const Projection measured = input.reference.path.Project(
          *row.measured, {std::max(0.0, input.station), std::max(0.0, input.station)});
      seen.cross_track = measured.cross_track;
      seen.heading_error = measured.heading_error;
    }
    seen.curvature = at.curvature;
    seen.planned_speed = at.direction * input.reference.speed.SpeedAt(input.station);
  }
  return seen;
}

py::dict ReferenceAt(const std::function<void(const std::function<void(const Reference&)>&)>& with,
                     const Numbers& stations) {
  const auto count = static_cast<std::size_t>(stations.size());
  const char* const names[]{"x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"};
  std::vector<py::array_t<double>> columns;
  std::vector<double*> cells;
  for (std::size_t i = 0; i < std::size(names); ++i) {
    columns.emplace_back(std::vector<py::ssize_t>{static_cast<py::ssize_t>(count)});
    cells.push_back(columns.back().mutable_data());
  }
  const double* const at = stations.data();
  {
    const WithoutGil release;
    with([&](const Reference& reference) {
      for (std::size_t i = 0; i < count; ++i) {
        const PathPoint point = reference.path.At(at[i]);
        const double speed = point.direction * reference.speed.SpeedAt(at[i]);
        const double numbers[]{point.pose.x,    point.pose.y, point.pose.yaw,
                               point.curvature, speed,        static_cast<double>(point.direction)};
        for (std::size_t column = 0; column < cells.size(); ++column) {
          cells[column][i] = numbers[column];
        }
      }
    });
  }
  py::dict result;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    result[names[i]] = columns[i];
  }
  return result;
}

namespace {

std::optional<std::string> StatusOf(const Observation& seen) {
  return seen.status ? std::optional<std::string>(ToString(*seen.status)) : std::nullopt;
}

py::dict AsDict(const Observation& seen) {
  py::dict fields;
  for (const Field& field : kFields) {
    fields[field.name] = field.value(seen);
  }
  fields["status"] = StatusOf(seen);
  fields["ended"] = seen.status.has_value();
  return fields;
}

}  // namespace

void BindObservation(py::module_& module) {
  py::class_<Observation, std::shared_ptr<Observation>> observation(
      module, "Observation",
      "What a controller receives in a control period: SI units and radians, NaN if unknown.");
  py::list names;
  for (const Field& field : kFields) {
    observation.def_property_readonly(field.name, field.value, field.doc);
    names.append(field.name);
  }
  observation.def_property_readonly(
      "status", &StatusOf, "How the run ended, such as \"arrived\"; None while it continues.");
  observation.def("asdict", &AsDict, "Returns all fields by their names, with status and ended.");
  observation.def("__repr__", [](const Observation& o) {
    return "<Observation " + py::repr(AsDict(o)).cast<std::string>() + ">";
  });
  observation.def_property_readonly(
      "ended", [](const Observation& o) { return o.status.has_value(); },
      "Whether the run has ended.");
  CopyAsItself(observation);
  observation.def("__reduce__", [](const Observation&) -> py::tuple {
    throw py::type_error("an Observation cannot be pickled; use seen.asdict()");
  });
  module.attr("observation_columns") = names;
}

}  // namespace trackbed::python
