#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "python/src/bindings.h"
#include "trackbed/analysis/parallel.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

namespace trackbed::python {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A planned scenario, from which loops are made.
struct Prepared {
  std::shared_ptr<const Scenario> scenario;
  std::shared_ptr<const CarModel> car;
  FeasiblePlan plan;
};

std::shared_ptr<Prepared> Prepare(const std::shared_ptr<Scenario>& scenario) {
  const py::gil_scoped_release release;
  std::shared_ptr<const CarModel> car = Cars().Load(*scenario);
  FeasiblePlan plan = PlanScenario(*scenario, *car);
  if (!plan.ok()) {
    throw RunError("no plan: " + plan->reason);
  }
  return std::make_shared<Prepared>(Prepared{scenario, std::move(car), std::move(plan)});
}

/// What the controller of a loop receives in a control period, with the tracking errors of the pose
/// that it receives.
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

constexpr Field kFields[]{
    {"t_s", [](const Observation& o) { return o.state.time; }, "Time since the start [s]."},
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
    {"lateral_acceleration_mps2", [](const Observation& o) { return o.state.lateral_acceleration; },
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
     "Smallest clearance from obstacles since the last observation [m]; NaN without obstacles."}};

Observation Observe(const SteppedLoop& loop) {
  const ControlInput input = loop.input();
  const LogRow& row = loop.row();
  Observation seen{.state = input.state,
                   .station = input.station,
                   .plan_time = input.plan_time,
                   .clearance = row.clearance.value_or(kUnknown),
                   .status = loop.status()};
  if (row.tracking) {
    const PathPoint at = input.reference.path.At(input.station);
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

/// A loop that Python steps. A mutex lets only one thread use the loop at a time.
class Loop {
 public:
  Loop(const Prepared& prepared, const std::string& plant, bool keeps_log)
      : loop_(MakeSteppedLoop(prepared.scenario, prepared.car, prepared.plan, plant, keeps_log)) {}

  /// Calls `use` with the loop, while no other thread uses it.
  template <typename Use>
  auto With(const Use& use) {
    const std::lock_guard lock(mutex_);
    return use(loop_);
  }

 private:
  std::mutex mutex_;
  SteppedLoop loop_;
};

/// Advances a loop by one control period. Without a steering angle, the scenario's controller
/// steers.
void Advance(SteppedLoop& loop, std::optional<double> steering,
             std::optional<double> acceleration) {
  if (loop.status()) {
    throw RunError(std::string("the run has ended (") + ToString(*loop.status()) +
                   "); call reset() or set state before the next step");
  }
  if (steering) {
    loop.Step(*steering, acceleration);
  } else {
    loop.Step();
  }
}

/// Loops that are stepped together on several threads.
class VectorLoop {
 public:
  VectorLoop(std::vector<std::shared_ptr<Loop>> loops, int threads)
      : loops_(std::move(loops)), threads_(threads) {}

  [[nodiscard]] std::size_t size() const { return loops_.size(); }

  /// Calls `work` with each loop and its index.
  template <typename Work>
  void ForEach(const Work& work) const {
    ForEachIndex(loops_.size(), threads_, [&](std::size_t i) {
      loops_[i]->With([&](SteppedLoop& loop) { work(i, loop); });
      return true;
    });
  }

 private:
  std::vector<std::shared_ptr<Loop>> loops_;
  int threads_;
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// An array for the observations of loops, with one row for each loop.
class ObservationRows {
 public:
  explicit ObservationRows(std::size_t count)
      : rows_({count, std::size(kFields)}), cells_(rows_.mutable_data()) {}

  /// Writes the observation of a loop to its row; needs no GIL.
  void Write(std::size_t row, const SteppedLoop& loop) {
    const Observation seen = Observe(loop);
    double* cell = cells_ + row * std::size(kFields);
    for (const Field& field : kFields) {
      *cell++ = field.value(seen);
    }
  }

  [[nodiscard]] const py::array_t<double>& rows() const { return rows_; }

 private:
  py::array_t<double> rows_;
  double* cells_;
};

py::array_t<double> ObserveAll(const VectorLoop& loops) {
  ObservationRows seen(loops.size());
  {
    const py::gil_scoped_release release;
    loops.ForEach([&](std::size_t i, const SteppedLoop& loop) { seen.Write(i, loop); });
  }
  return seen.rows();
}

/// Advances all loops that have not ended, each with its steering angle and acceleration, and
/// returns the observations after that. An acceleration of NaN leaves the speed to the plan.
py::array_t<double> AdvanceAll(const VectorLoop& loops, const std::optional<Numbers>& steering,
                               const std::optional<Numbers>& acceleration) {
  const double* const angles = steering ? steering->data() : nullptr;
  const double* const rates = acceleration ? acceleration->data() : nullptr;
  ObservationRows seen(loops.size());
  {
    const py::gil_scoped_release release;
    loops.ForEach([&](std::size_t i, SteppedLoop& loop) {
      if (!loop.status()) {
        const bool has_rate = rates != nullptr && !std::isnan(rates[i]);
        Advance(loop, angles != nullptr ? std::optional(angles[i]) : std::nullopt,
                has_rate ? std::optional(rates[i]) : std::nullopt);
      }
      seen.Write(i, loop);
    });
  }
  return seen.rows();
}

/// Reads the path, the speeds and the directions of the present plan at `stations`.
py::dict ReferenceAt(Loop& loop, const Numbers& stations) {
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
    const py::gil_scoped_release release;
    loop.With([&](const SteppedLoop& own) {
      const Reference& reference = own.plan().reference;
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

void BindObservation(py::module_& module) {
  py::class_<Observation> observation(module, "Observation");
  py::list names;
  for (const Field& field : kFields) {
    observation.def_property_readonly(field.name, field.value, field.doc);
    names.append(field.name);
  }
  observation.def_property_readonly(
      "status", [](const Observation& o) -> std::optional<std::string> {
        return o.status ? std::optional<std::string>(ToString(*o.status)) : std::nullopt;
      });
  observation.def_property_readonly("ended",
                                    [](const Observation& o) { return o.status.has_value(); });
  module.attr("observation_columns") = names;
}

}  // namespace

void BindLoops(py::module_& module) {
  BindObservation(module);
  py::class_<Prepared, std::shared_ptr<Prepared>>(module, "Prepared")
      .def_property_readonly("period",
                             [](const Prepared& p) { return p.scenario->drive.control_period; })
      .def_property_readonly("steering_limit",
                             [](const Prepared& p) { return p.car->params().steering_limit; })
      .def_property_readonly("path_length",
                             [](const Prepared& p) { return p.plan->reference.path.length(); });
  module.def("prepare", &Prepare);

  py::class_<SteppedLoop, std::shared_ptr<SteppedLoop>>(module, "LoopState");
  py::class_<Loop, std::shared_ptr<Loop>>(module, "Loop")
      .def(py::init([](const Prepared& prepared, const std::string& plant, bool keeps_log) {
        const py::gil_scoped_release release;
        return std::make_shared<Loop>(prepared, plant, keeps_log);
      }))
      .def("restart",
           [](Loop& self, const Prepared& prepared, const std::string& plant, bool keeps_log) {
             const py::gil_scoped_release release;
             SteppedLoop started =
                 MakeSteppedLoop(prepared.scenario, prepared.car, prepared.plan, plant, keeps_log);
             self.With([&](SteppedLoop& loop) { loop = std::move(started); });
           })
      .def("step",
           [](Loop& self, std::optional<double> steering, std::optional<double> acceleration) {
             const py::gil_scoped_release release;
             return self.With([&](SteppedLoop& loop) {
               Advance(loop, steering, acceleration);
               return Observe(loop);
             });
           })
      .def("observe",
           [](Loop& self) {
             const py::gil_scoped_release release;
             return self.With([](const SteppedLoop& loop) { return Observe(loop); });
           })
      .def("save",
           [](Loop& self) {
             const py::gil_scoped_release release;
             return self.With([](const SteppedLoop& loop) {
               return std::make_shared<SteppedLoop>(loop.Copy());
             });
           })
      .def("restore",
           [](Loop& self, const SteppedLoop& state) {
             const py::gil_scoped_release release;
             SteppedLoop copy = state.Copy();
             self.With([&](SteppedLoop& loop) { loop = std::move(copy); });
           })
      .def("reference", &ReferenceAt)
      .def("log", [](Loop& self) {
        const py::gil_scoped_release release;
        return std::make_shared<Columns>(
            self.With([](const SteppedLoop& loop) { return ToTable(loop.log()); }));
      });

  py::class_<VectorLoop>(module, "VectorLoop")
      .def(py::init<std::vector<std::shared_ptr<Loop>>, int>())
      .def("observe", &ObserveAll)
      .def("step", &AdvanceAll)
      .def_property_readonly("ended", [](const VectorLoop& self) {
        py::array_t<bool> ended(static_cast<py::ssize_t>(self.size()));
        bool* const cells = ended.mutable_data();
        const py::gil_scoped_release release;
        self.ForEach(
            [&](std::size_t i, const SteppedLoop& loop) { cells[i] = loop.status().has_value(); });
        return ended;
      });
}

}  // namespace trackbed::python
