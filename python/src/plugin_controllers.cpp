#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "python/src/observation.h"
#include "python/src/plugin_slots.h"
#include "trackbed/control/controllers.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/log_columns.h"

namespace trackbed::python {
namespace {

struct ControllerKind {};

/// The observation of a controller, with the plan, which can be read until the controller returns.
struct ControllerInput : Observation {
  ControllerInput(const ControlInput& given)  // NOLINT(google-explicit-constructor): extends it
      : Observation(Observe(given)), period(given.period), vehicle(given.vehicle), input(&given) {}

  double period;
  VehicleParams vehicle;
  const ControlInput* input;  ///< Null after the controller has returned.
};

/// A controller that calls an object of Python.
class PluginController final : public SteeringController {
 public:
  explicit PluginController(PluginOptions options) : options_(std::move(options)) {
    Ask(plugin(), [&] {
      Take(Kept(plugin().adapter.object().attr("make")(KeywordsOf(options_))));
      return 0;
    });
  }

  double Steer(const ControlInput& input) override {
    return Ask(plugin(), [&] {
      const auto seen = std::make_shared<ControllerInput>(input);
      // Also reached if the controller throws.
      const std::shared_ptr<void> end(nullptr, [&](void*) { seen->input = nullptr; });
      const auto command = object_.object().attr("step")(seen).cast<py::tuple>();
      const auto steering = command[0].cast<double>();
      acceleration_ = command[1].cast<std::optional<double>>();
      if (!columns_.empty()) {
        values_ = ToNumbers(command[2]);
      }
      return steering;
    });
  }

  std::optional<double> Accelerate(const ControlInput& /*input*/) override { return acceleration_; }
  [[nodiscard]] std::vector<std::string> Columns() const override { return columns_; }
  [[nodiscard]] std::vector<double> Values() const override { return values_; }

  [[nodiscard]] std::unique_ptr<SteeringController> Clone() const override {
    auto copy = std::unique_ptr<PluginController>(new PluginController(*this));
    copy->object_ = Ask(plugin(), [&] { return Kept(object_.object().attr("copy")()); });
    return copy;
  }

 private:
  PluginController(const PluginController&) = default;

  [[nodiscard]] const Plugin& plugin() const { return *options_.plugin; }

  void Take(Kept object) {
    object_ = std::move(object);
    columns_ = object_.object().attr("columns").cast<std::vector<std::string>>();
    values_.assign(columns_.size(), kUnknown);
  }

  PluginOptions options_;
  Kept object_;
  std::optional<double> acceleration_{};
  std::vector<std::string> columns_{};
  std::vector<double> values_{};
};

template <std::size_t Slot>
struct MakeControllerEntry {
  using Options = SlotOptions<ControllerKind, Slot>;

  static std::unique_ptr<SteeringController> MakeInSlot(const ControllerOptions& options) {
    return std::make_unique<PluginController>(Bound(options.Get<Options>()));
  }

  static ControllerEntry Make(const Plugin& plugin) {
    return {.name = plugin.name.c_str(),
            .summary = plugin.summary.c_str(),
            .defaults = Options{},
            .make = MakeInSlot};
  }
};

py::dict ReferenceOf(const ControllerInput& seen, const py::object& stations) {
  if (seen.input == nullptr) {
    throw std::runtime_error("reference() can only be called until step returns");
  }
  const py::object row =
      py::module_::import("trackbed._arguments").attr("row")("stations", stations);
  return ReferenceAt([&](const auto& use) { use(seen.input->reference); }, row.cast<Numbers>());
}

}  // namespace

void RegisterPythonController(const py::dict& given) {
  RegisterInSlot<ControllerKind, MakeControllerEntry>(
      ReadPlugin(given), [&](ControllerEntry entry) {
        entry.needs_plan = given["needs_plan"].cast<bool>();
        entry.station =
            given["odometer"].cast<bool>() ? StationSource::kOdometer : StationSource::kProjection;
        RegisterController(std::move(entry));
      });
}

void BindControllerInput(py::module_& module) {
  py::class_<ControllerInput, Observation, std::shared_ptr<ControllerInput>>(
      module, "ControllerInput",
      "Input of a controller in a control period: an Observation without clearance and status.")
      .def_readonly("period", &ControllerInput::period, "Length of a control period [s].")
      .def_readonly("vehicle", &ControllerInput::vehicle, "The car, a Vehicle.")
      .def("reference", &ReferenceOf, py::arg("stations"),
           "Returns points of the present plan, as Loop.reference does.\n\n"
           "stations: stations on the plan [m], an array with the shape (n,). Returns arrays with\n"
           "the shape (n,): x_m, y_m, yaw_rad, curvature_radpm, speed_mps, direction. Can only be\n"
           "called until `step` returns.");
  module.attr("log_columns") = LogColumns(
      LogContents{.path = true, .obstacles = true, .noise = true, .wheels = true, .gaps = true});
}

}  // namespace trackbed::python
