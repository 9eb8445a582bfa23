#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "python/src/joined_path.h"
#include "python/src/observation.h"
#include "python/src/plugin_slots.h"
#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"

// Calls a planner in Python with the mission, the car and the obstacles. Fits the smoothest curve
// to the returned points. Joins a curve without reversals to the heading and the steering angle of
// the car. Plans the speeds of this path and checks its feasibility, as the planner path_file does.
namespace trackbed::python {
namespace {

struct PlannerKind {};

/// Result of a planner in Python.
struct Answer {
  std::string no_path;  ///< Reason why there is no path; empty if there is a path.
  PathPoints points;
  double max_deviation = 0.0;
  std::vector<std::string> notes;
};

std::vector<double> ColumnOf(const Numbers& table, py::ssize_t column) {
  std::vector<double> numbers;
  for (py::ssize_t row = 0; row < table.shape(0); ++row) {
    numbers.push_back(table.at(row, column));
  }
  return numbers;
}

Answer ReadAnswer(const py::dict& given) {
  Answer answer;
  if (!given["no_path"].is_none()) {
    answer.no_path = given["no_path"].cast<std::string>();
    return answer;
  }
  const auto points = given["points"].cast<Numbers>();
  for (py::ssize_t row = 0; row < points.shape(0); ++row) {
    answer.points.points.emplace_back(points.at(row, 0), points.at(row, 1));
  }
  if (points.shape(1) == 3) {
    answer.points.yaw = ColumnOf(points, 2);
  }
  if (!given["speed"].is_none()) {
    answer.points.speed = ToNumbers(given["speed"]);
  }
  answer.max_deviation = given["max_deviation"].cast<double>();
  answer.notes = given["notes"].cast<std::vector<std::string>>();
  return answer;
}

[[noreturn]] void Refuse(const Plugin& plugin, const std::string& why) {
  throw PluginError(fmt::format("{} '{}' ({}) returned a path that {}", plugin.kind, plugin.name,
                                plugin.place, why),
                    Kept());
}

/// Returns why a path with a reversal is refused, with a remedy for the points of a planner.
std::string ReversalReason(const FittedPath& fitted) {
  const HeadingJump& first = fitted.reversals.front();
  std::string text = fmt::format("the path turns back on itself by {:.3g} rad at ({:.6g}, {:.6g})",
                                 std::abs(first.angle), first.position.x(), first.position.y());
  text += fitted.given.yaw.empty()
              ? "; if the car reverses there, return points of shape (n, 3) with the car's yaw"
              : "; the yaw of the points says that the car keeps its direction of motion there";
  if (fitted.noise_deviation) {
    text += fmt::format(
        "; if this is noise of the points, return a PlannedPath with max_deviation "
        "{:.2g}",
        std::max(*fitted.noise_deviation, fitted.options.max_deviation));
  }
  return text;
}

/// Fits a path to the points and plans along it, as the planner `path_file` does.
Plan PlanAlong(const Plugin& plugin, const PlanRequest& request, Answer answer) {
  PathFileOptions options;
  options.fit.max_deviation = answer.max_deviation;
  options.speeds = answer.points.speed.empty() ? PathSpeeds::kMission : PathSpeeds::kFile;
  const Vec2 first = answer.points.points.front();
  const double miss = (first - request.start.position()).norm();
  if (miss > answer.max_deviation) {
    Refuse(plugin, fmt::format("begins at ({:.6g}, {:.6g}), {:.4g} m from the start ({:.6g}, "
                               "{:.6g}); must begin within max_deviation = {:.4g} m of the start",
                               first.x(), first.y(), miss, request.start.x, request.start.y,
                               answer.max_deviation));
  }
  answer.points.points.front() = request.start.position();
  try {
    FittedPath fitted = FitPath(std::move(answer.points), options.fit);
    if (fitted.reversals.empty()) {
      fitted.path = JoinedToStart(fitted.path, request, answer.max_deviation);
    }
    options.path = std::make_shared<const FittedPath>(std::move(fitted));
  } catch (const InputError& error) {
    Refuse(plugin, "cannot be fitted: " + error.problems().front().message);
  }
  Plan plan = PathFilePlanner().plan(request, options);
  if (plan.status == PlanStatus::kUTurn && !options.path->reversals.empty()) {
    plan.reason = ReversalReason(*options.path);
  }
  plan.notes.insert(plan.notes.end(), answer.notes.begin(), answer.notes.end());
  return plan;
}

Plan PlanBy(const PluginOptions& options, const PlanRequest& request, bool goes_backwards) {
  const Plugin& plugin = *options.plugin;
  Answer answer = Ask(plugin, [&] {
    const auto copy = std::make_shared<PlanRequest>(request);
    return ReadAnswer(plugin.adapter.object().attr("plan")(copy, KeywordsOf(options)));
  });
  if (!answer.no_path.empty()) {
    Plan plan;
    plan.status = PlanStatus::kNoPath;
    plan.reason = answer.no_path;
    return plan;
  }
  Plan plan = PlanAlong(plugin, request, std::move(answer));
  const bool reverses = plan.ok() && std::any_of(plan.reference.path.segments().begin(),
                                                 plan.reference.path.segments().end(),
                                                 [](const Segment& s) { return s.direction < 0; });
  if (reverses && !goes_backwards) {
    Refuse(plugin, "drives in reverse; register the planner with goes_backwards=True");
  }
  return plan;
}

template <std::size_t Slot>
struct MakePlannerEntry {
  using Options = SlotOptions<PlannerKind, Slot>;

  static Plan PlanInSlot(const PlanRequest& request, const PlannerOptions& options) {
    const PlannerEntry& entry = PlannerFor(options);
    return PlanBy(Bound(options.Get<Options>()), request, entry.goes_backwards);
  }

  static PlannerEntry Make(const Plugin& plugin) {
    return {.name = plugin.name.c_str(),
            .summary = plugin.summary.c_str(),
            .defaults = Options{},
            .plan = PlanInSlot};
  }
};

py::array_t<double> ToArray(const std::vector<double>& numbers, py::ssize_t columns) {
  const auto rows = static_cast<py::ssize_t>(numbers.size()) / columns;
  py::array_t<double> array({rows, columns});
  std::copy(numbers.begin(), numbers.end(), array.mutable_data());
  return array;
}

py::array_t<double> WaypointsOf(const PlanRequest& request) {
  std::vector<double> numbers;
  for (const Vec2& point : request.waypoints) {
    numbers.insert(numbers.end(), {point.x(), point.y()});
  }
  return ToArray(numbers, 2);
}

py::array_t<double> ObstaclesOf(const PlanRequest& request) {
  std::vector<double> numbers;
  for (const OrientedBox& box : request.obstacles) {
    numbers.insert(numbers.end(),
                   {box.center.x, box.center.y, box.center.yaw, box.length, box.width});
  }
  return ToArray(numbers, 5);
}

/// Returns the clearance at each pose, a row (x, y, yaw).
py::array_t<double> ClearanceAt(const PlanRequest& request, const Numbers& poses) {
  py::array_t<double> result(std::vector<py::ssize_t>{poses.shape(0)});
  const double* const pose = poses.data();
  double* const clearance = result.mutable_data();
  const auto count = static_cast<std::size_t>(poses.shape(0));
  const WithoutGil release;
  const CollisionChecker checker(request.vehicle, request.obstacles, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    clearance[i] = checker.Clearance({pose[3 * i], pose[3 * i + 1], pose[3 * i + 2]});
  }
  return result;
}

}  // namespace

void RegisterPythonPlanner(const py::dict& given) {
  RegisterInSlot<PlannerKind, MakePlannerEntry>(ReadPlugin(given), [&](PlannerEntry entry) {
    entry.min_waypoints = given["min_waypoints"].cast<std::size_t>();
    entry.keeps_clear = given["keeps_clear"].cast<bool>();
    entry.goes_backwards = given["goes_backwards"].cast<bool>();
    entry.is_random = given["is_random"].cast<bool>();
    RegisterPlanner(std::move(entry));
  });
}

void BindPlannerRequest(py::module_& module) {
  py::class_<VehicleParams> vehicle(module, "Vehicle",
                                    "Parameters of a car, in SI units and radians.");
  CopyAsItself(vehicle);
  vehicle.def_readonly("name", &VehicleParams::name, "Name of the model.")
      .def_readonly("wheelbase", &VehicleParams::wheelbase,
                    "Wheelbase [m]; with differential drive, the track of the driven wheels.")
      .def_readonly("cg_to_rear", &VehicleParams::cg_to_rear,
                    "Distance from the center of gravity to the rear axle [m].")
      .def_readonly("mass", &VehicleParams::mass, "Mass [kg].")
      .def_readonly("yaw_inertia", &VehicleParams::yaw_inertia,
                    "Yaw inertia about the center of gravity [kg m^2].")
      .def_readonly("cornering_stiffness_front", &VehicleParams::cornering_stiffness_front,
                    "Cornering stiffness of the front axle [N/rad]; 0 without coefficients.")
      .def_readonly("cornering_stiffness_rear", &VehicleParams::cornering_stiffness_rear,
                    "Cornering stiffness of the rear axle [N/rad]; 0 without coefficients.")
      .def_readonly("steering_limit", &VehicleParams::steering_limit,
                    "Largest steering angle of the bicycle model [rad].")
      .def_readonly("steering_rate", &VehicleParams::steering_rate,
                    "Largest rate of the steering angle [rad/s].")
      .def_readonly("length", &VehicleParams::length, "Length of the footprint [m].")
      .def_readonly("width", &VehicleParams::width, "Width of the footprint [m].")
      .def_readonly("rear_overhang", &VehicleParams::rear_overhang,
                    "Distance from the rear axle to the rear end of the footprint [m].")
      .def_readonly("max_acceleration", &VehicleParams::max_acceleration,
                    "Largest acceleration on a flat road [m/s^2]; 0 if unknown.")
      .def_readonly("max_deceleration", &VehicleParams::max_deceleration,
                    "Largest deceleration on a flat road [m/s^2]; 0 if unknown.")
      .def_readonly("top_speed", &VehicleParams::top_speed, "Top speed [m/s]; 0 if unlimited.")
      .def_property_readonly("min_turning_radius", &VehicleParams::min_turning_radius,
                             "Smallest turning radius of the rear-axle center [m].");

  py::class_<PlanRequest, std::shared_ptr<PlanRequest>>(module, "PlanRequest")
      .def_readonly("vehicle", &PlanRequest::vehicle)
      .def_property_readonly("waypoints", &WaypointsOf)
      .def_readonly("headings", &PlanRequest::headings)
      .def_property_readonly("obstacles", &ObstaclesOf)
      .def_property_readonly("start",
                             [](const PlanRequest& request) {
                               const Pose2& pose = request.start;
                               return py::make_tuple(pose.x, pose.y, pose.yaw);
                             })
      .def_readonly("start_speed", &PlanRequest::start_speed)
      .def_readonly("start_steering", &PlanRequest::start_steering)
      .def_property_readonly("speed", [](const PlanRequest& r) { return r.speed.speed; })
      .def_readonly("seed", &PlanRequest::seed)
      .def_readonly("friction", &PlanRequest::friction)
      .def_readonly("max_waypoint_miss", &PlanRequest::max_waypoint_miss)
      .def("clearance", &ClearanceAt);
}

}  // namespace trackbed::python
