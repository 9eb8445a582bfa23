#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "python/src/plugin_slots.h"
#include "trackbed/sim/plant.h"

namespace trackbed::python {
namespace {

struct PlantKind {};

/// The numbers that an adapter returns for the state of a plant, in the order of kStateColumns.
constexpr std::array<std::pair<const char*, double VehicleState::*>, 10> kStateColumns{
    {{"speed_mps", &VehicleState::speed},
     {"lateral_speed_mps", &VehicleState::lateral_speed},
     {"yaw_rate_radps", &VehicleState::yaw_rate},
     {"roll_rad", &VehicleState::roll},
     {"pitch_rad", &VehicleState::pitch},
     {"longitudinal_acceleration_mps2", &VehicleState::longitudinal_acceleration},
     {"lateral_acceleration_mps2", &VehicleState::lateral_acceleration},
     {"sideslip_rad", &VehicleState::sideslip},
     {"steering_actuator_rad", &VehicleState::steering_actuator},
     {"steering_rad", &VehicleState::steering}}};

/// Arguments of the constructor of a plant in Python.
struct PlantStart {
  double timestep = 0.0;
  double friction = 1.0;
  VehicleParams vehicle;
  StartState start;
};

/// A plant that calls an object of Python.
class PluginPlant final : public Plant {
 public:
  PluginPlant(std::shared_ptr<const Plugin> plugin, const PlantSetup& setup)
      : plugin_(std::move(plugin)), car_(setup.car) {
    state_.pose = setup.start.pose;
    state_.speed = setup.start.speed;
    state_.steering = setup.start.steering;
    state_.steering_actuator = setup.start.steering;
    const auto start = std::make_shared<PlantStart>(PlantStart{.timestep = car_.timestep(),
                                                               .friction = setup.world.friction,
                                                               .vehicle = car_.params(),
                                                               .start = setup.start});
    Ask(*plugin_, [&] {
      object_ = Kept(plugin_->adapter.object().attr("make")(start));
      Read(object_.object().attr("state")());
      return 0;
    });
  }

  void Step(const Command& command) override {
    const VehicleState before = state_;
    state_.steering = command.steering;
    state_.steering_actuator = command.steering;
    Ask(*plugin_, [&] {
      Read(object_.object().attr("step")(command.steering,
                                         command.coast ? 0.0 : command.acceleration, command.gear));
      return 0;
    });
    const double timestep = car_.timestep();
    if (std::isnan(state_.yaw_rate)) {
      state_.yaw_rate = (state_.pose.yaw - before.pose.yaw) / timestep;
    }
    state_.time = before.time + timestep;
    state_.distance =
        before.distance + 0.5 * (std::abs(before.speed) + std::abs(state_.speed)) * timestep;
  }

  void ApplyLateralOffset(double left) override {
    Ask(*plugin_, [&] {
      Read(object_.object().attr("offset")(left));
      return 0;
    });
  }

  void ApplyLateralForce(double force) override {
    Ask(*plugin_, [&] {
      object_.object().attr("push")(force);
      return 0;
    });
  }

  [[nodiscard]] VehicleState Observe() const override { return state_; }
  [[nodiscard]] Pose2 pose() const override { return state_.pose; }
  [[nodiscard]] std::vector<double> Configuration() const override {
    return car_.FlatConfiguration(state_.pose, state_.steering, {});
  }
  /// Whether a coordinate exceeds the limit of the built-in plants. _plugins.py refuses NaN.
  [[nodiscard]] bool diverged() const override {
    constexpr double kMaxCoordinate = 1e10;
    return !(std::abs(state_.pose.x) < kMaxCoordinate && std::abs(state_.pose.y) < kMaxCoordinate &&
             std::abs(state_.pose.yaw) < kMaxCoordinate);
  }
  [[nodiscard]] std::string divergence() const override {
    return diverged() ? "the plant's position or yaw is beyond 1e10" : "";
  }

  [[nodiscard]] std::unique_ptr<Plant> Clone() const override {
    auto copy = std::unique_ptr<PluginPlant>(new PluginPlant(*this));
    copy->object_ = Ask(*plugin_, [&] { return Kept(object_.object().attr("copy")()); });
    return copy;
  }

 private:
  PluginPlant(const PluginPlant&) = default;

  /// Reads x, y, yaw and the columns of a state. A value None in Python leaves the column
  /// unchanged. A missing yaw rate becomes NaN, which Step replaces by the rate of the heading.
  void Read(const py::object& given) {
    const auto numbers = given.cast<py::tuple>();
    state_.pose = {numbers[0].cast<double>(), numbers[1].cast<double>(), numbers[2].cast<double>()};
    state_.yaw_rate = kUnknownRate;
    for (std::size_t i = 0; i < kStateColumns.size(); ++i) {
      const py::object value = numbers[3 + i];
      if (!value.is_none()) {
        state_.*kStateColumns[i].second = value.cast<double>();
      }
    }
    if (std::isnan(state_.yaw_rate) && state_.time == 0.0) {
      state_.yaw_rate = state_.speed * CurvatureForSteering(car_.params(), state_.steering);
    }
  }

  static constexpr double kUnknownRate = std::numeric_limits<double>::quiet_NaN();

  std::shared_ptr<const Plugin> plugin_;
  const CarModel& car_;
  Kept object_{};
  VehicleState state_{};
};

}  // namespace

void RegisterPythonPlant(const py::dict& given) {
  auto plugin = ReadPlugin(given);
  RequireNothingRuns(*plugin);
  auto& plants = PluginsOf<PlantKind>();
  for (auto& other : plants) {
    if (other->name == plugin->name) {
      other = plugin;
      return;
    }
  }
  // Never destroyed, because the registry refers to the texts.
  static auto* const first_versions = new std::vector<std::shared_ptr<const Plugin>>;
  first_versions->push_back(plugin);
  const std::size_t slot = plants.size();
  RegisterPlant({.name = plugin->name.c_str(),
                 .summary = plugin->summary.c_str(),
                 .make = [slot](const PlantSetup& setup) -> std::unique_ptr<Plant> {
                   return std::make_unique<PluginPlant>(PluginsOf<PlantKind>()[slot], setup);
                 }});
  plants.push_back(std::move(plugin));
}

void BindPlantSetup(py::module_& module) {
  py::class_<PlantStart, std::shared_ptr<PlantStart>> setup(
      module, "PlantSetup", "Input of a plant at its start, in SI units and radians.");
  CopyAsItself(setup);
  setup.def_readonly("timestep", &PlantStart::timestep, "Time that a step simulates [s].")
      .def_readonly("friction", &PlantStart::friction, "Factor on the friction of the tyres [1].")
      .def_readonly("vehicle", &PlantStart::vehicle, "The car, a Vehicle.")
      .def_property_readonly(
          "x_m", [](const PlantStart& s) { return s.start.pose.x; },
          "x of the rear-axle center at the start [m].")
      .def_property_readonly(
          "y_m", [](const PlantStart& s) { return s.start.pose.y; },
          "y of the rear-axle center at the start [m].")
      .def_property_readonly(
          "yaw_rad", [](const PlantStart& s) { return s.start.pose.yaw; },
          "Yaw at the start [rad], positive to the left.")
      .def_property_readonly(
          "speed_mps", [](const PlantStart& s) { return s.start.speed; },
          "Speed at the start [m/s], negative backwards.")
      .def_property_readonly(
          "steering_rad", [](const PlantStart& s) { return s.start.steering; },
          "Steering angle at the start [rad], positive to the left.");
  py::list names;
  for (const auto& [name, member] : kStateColumns) {
    names.append(name);
  }
  module.attr("state_columns") = names;
}

}  // namespace trackbed::python
