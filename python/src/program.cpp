#include "python/src/plugin_threads.h"
#include "python/src/plugins.h"
#include "trackbed/cli/main.h"
#include "trackbed/control/controllers.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/keys.h"

// The entry points for _signatures.py and __main__.py: registration, the exceptions of plug-ins,
// and the program.
namespace trackbed::python {
namespace {

/// Raises the exception of a plug-in in Python, as the cause of trackbed.PluginError.
void Raise(const PluginError& error, const py::object& type) {
  const py::object raised = type(error.what());
  if (error.cause()) {
    const py::object cause = error.cause().object();
    PyException_SetCause(raised.ptr(), py::object(cause).release().ptr());
  }
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void TranslateErrors(std::exception_ptr pointer) {
  try {
    if (pointer) {
      std::rethrow_exception(std::move(pointer));
    }
  } catch (const PluginError& error) {
    Raise(error, py::module_::import("trackbed._trackbed").attr("PluginError"));
  } catch (const PluginInterrupt& error) {
    const py::object& raised = error.cause().object();
    PyErr_SetObject(py::type::of(raised).ptr(), raised.ptr());
  }
}

/// Returns the keys of a section that belong to no method, which plug-ins cannot have.
std::vector<std::string> KeysOfSection(const std::string& section) {
  std::vector<std::string> names{"method"};
  for (const KeySection& own : ScenarioKeys()) {
    if (own.key == section && own.method.empty()) {
      for (const KeyInfo& key : own.keys) {
        names.push_back(key.name);
      }
    }
  }
  return names;
}

int RunProgram(std::vector<std::string> arguments) {
  PrintTracebacks();
  std::vector<char*> pointers;
  for (std::string& argument : arguments) {
    pointers.push_back(argument.data());
  }
  pointers.push_back(nullptr);
  const WithoutGil release;
  return Main(static_cast<int>(arguments.size()), pointers.data());
}

}  // namespace

void BindPlugins(py::module_& module) {
  py::register_exception<MethodError>(module, "PluginError", PyExc_RuntimeError);
  py::register_exception_translator(&TranslateErrors);
  module.def("register_planner", &RegisterPythonPlanner);
  module.def("register_controller", &RegisterPythonController);
  module.def("register_plant", &RegisterPythonPlant);
  module.def("register_metric", &RegisterPythonMetric);
  module.def("keys_of_section", &KeysOfSection);
  module.def("interrupt_plugins", &InterruptPlugins);
  module.def("begin_end", &BeginEnd);
  module.def("running_functions", [] { return RunningFunction::Count().load(); });
  module.def("forget_other_threads", &ForgetOtherThreads);
  BindPlannerRequest(module);
  BindControllerInput(module);
  BindPlantSetup(module);
}

void BindProgram(py::module_& module) {
  module.def("main", &RunProgram);
}

}  // namespace trackbed::python
