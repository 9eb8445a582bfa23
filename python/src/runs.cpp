#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "python/src/bindings.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/plan_table.h"
#include "trackbed/drive/car_cache.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/scenario_files.h"

namespace trackbed::python {

namespace fs = std::filesystem;

Columns::Columns(const Table& table) : names_(table.columns()), rows_(table.rows()) {
  cells_.reserve(names_.size() * rows_);
  for (std::size_t column = 0; column < names_.size(); ++column) {
    for (std::size_t row = 0; row < rows_; ++row) {
      cells_.push_back(table.at(row, column));
    }
  }
}

std::optional<const double*> Columns::Find(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) {
    return std::nullopt;
  }
  return cells_.data() + static_cast<std::size_t>(found - names_.begin()) * rows_;
}

py::object ToPython(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

bool Signals::Raised() {
  const auto now = std::chrono::steady_clock::now();
  if (error_ || now < next_) {
    return error_ != nullptr;
  }
  if (EndsThisThread()) {
    return true;
  }
  next_ = now + std::chrono::milliseconds(20);
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) {
    error_ = std::make_shared<py::error_already_set>();
  }
  return error_ != nullptr;
}

void Signals::Rethrow() {
  if (error_) {
    throw py::error_already_set(*std::exchange(error_, nullptr));
  }
}

CarCache& Cars() {
  // Never destroyed, because threads may use cars until the process ends.
  static auto* const cars = new CarCache;
  return *cars;
}

namespace {

std::shared_ptr<Scenario> Load(const fs::path& file, const std::vector<std::string>& overrides,
                               const std::vector<fs::path>& asset_folders) {
  const WithoutGil release;
  return std::make_shared<Scenario>(LoadScenario(FindScenario(file), overrides, asset_folders));
}

std::shared_ptr<RunResult> Run(const std::shared_ptr<Scenario>& scenario) {
  Signals signals;
  std::shared_ptr<RunResult> result;
  {
    const WithoutGil release;
    const RunHooks hooks{.drive = [&](const std::string&) {
      return DriveHooks{.interrupted = [&] { return signals.Raised(); }};
    }};
    result = std::make_shared<RunResult>(RunScenario(*scenario, Cars(), hooks));
  }
  signals.Rethrow();
  return result;
}

std::shared_ptr<Columns> LogOf(const RunResult& run, const std::string& plant) {
  const std::optional<PlantRun> found = run.Find(plant);
  return found ? std::make_shared<Columns>(ToTable(found->log)) : nullptr;
}

/// Returns the metrics of a plant by their paths, such as "cross_track.max".
py::dict MetricValuesOf(const RunResult& run, const std::string& plant) {
  py::dict values;
  if (const std::optional<PlantRun> found = run.Find(plant)) {
    for (const Metric& metric : ListMetrics(found->metrics)) {
      values[py::str(metric.path)] = python::ToPython(ToJson(metric.value));
    }
  }
  return values;
}

void BindColumns(py::module_& module) {
  py::class_<Columns, std::shared_ptr<Columns>>(module, "Columns")
      .def_property_readonly("names", &Columns::names)
      .def_property_readonly("rows", &Columns::rows)
      .def("column", [](const py::object& self, const std::string& name) {
        const auto& columns = self.cast<const Columns&>();
        const std::optional<const double*> column = columns.Find(name);
        if (!column) {
          throw py::key_error(name);
        }
        // The array refers to the memory of `self`, and keeps it alive.
        // Without the stride, pybind11 before 2.12 takes 0 with NumPy 2, as if all rows were equal.
        const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(columns.rows())};
        const std::vector<py::ssize_t> strides{sizeof(double)};
        py::array_t<double> array(shape, strides, *column, self);
        array.attr("setflags")(py::arg("write") = false);
        return array;
      });
}

}  // namespace

void BindRuns(py::module_& module) {
  BindColumns(module);
  py::class_<Scenario, std::shared_ptr<Scenario>>(module, "Scenario")
      .def_readonly("name", &Scenario::name)
      .def_readonly("seed", &Scenario::seed)
      .def_property_readonly("plants", [](const Scenario& s) { return s.drive.plants; })
      .def_property_readonly("yaml", [](const Scenario& s) { return ResolvedYaml(s); });
  module.def("load", &Load);

  py::class_<RunResult, std::shared_ptr<RunResult>>(module, "RunResult")
      .def_property_readonly("name", [](const RunResult& run) { return run.scenario.name; })
      .def_property_readonly("yaml",
                             [](const RunResult& run) { return ResolvedYaml(run.scenario); })
      .def_property_readonly("plants",
                             [](const RunResult& run) {
                               std::vector<std::string> plants;
                               for (const RunLog& log : run.logs) {
                                 plants.push_back(log.plant);
                               }
                               return plants;
                             })
      .def_property_readonly("metrics",
                             [](const RunResult& run) { return ToPython(MetricsJson(run)); })
      .def_property_readonly("plan",
                             [](const RunResult& run) -> py::object {
                               return run.scenario.plan ? ToPython(PlanJson(run)) : py::none();
                             })
      .def_property_readonly("plan_notes", [](const RunResult& run) { return run.plan->notes; })
      .def_property_readonly("notes", [](const RunResult& run) { return run.verdict.notes; })
      .def("path",
           [](const RunResult& run) -> std::shared_ptr<Columns> {
             const bool has_path = run.plan.ok() && run.plan->reference.path.length() > 0.0;
             return has_path ? std::make_shared<Columns>(PlanTable(*run.plan)) : nullptr;
           })
      .def("log", &LogOf)
      .def("metric_values", &MetricValuesOf)
      .def("write", [](const RunResult& run, const fs::path& folder, bool mcap) {
        const WithoutGil release;
        WriteRunFolder(run, folder, {.mcap = mcap});
      });
  module.def("run", &Run);
  module.def("metric_names", [] {
    std::vector<std::string> names;
    for (const MetricEntry& entry : Metrics()) {
      names.push_back(entry.path);
    }
    return names;
  });
}

}  // namespace trackbed::python
