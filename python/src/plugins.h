#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/bindings.h"
#include "trackbed/core/method_error.h"
#include "trackbed/options/key_visitor.h"

/// Plug-ins: planners, controllers, plants and metrics that are written in Python. C++ calls an
/// adapter of _plugins.py, which checks and converts the results of the user's function.
namespace trackbed::python {

/// A Python object that threads without the GIL may copy and destroy.
class Kept {
 public:
  Kept() = default;
  explicit Kept(py::object object);

  explicit operator bool() const { return object_ != nullptr; }

  /// Requires the GIL.
  [[nodiscard]] const py::object& object() const { return *object_; }

 private:
  std::shared_ptr<const py::object> object_;
};

/// An exception of a plug-in. In Python, it becomes trackbed.PluginError, whose cause is the
/// exception of the plug-in with its traceback.
class PluginError : public MethodError {
 public:
  PluginError(const std::string& message, Kept cause)
      : MethodError(message), cause_(std::move(cause)) {}

  [[nodiscard]] const Kept& cause() const { return cause_; }

 private:
  Kept cause_;
};

/// An exception of a plug-in that no code should handle, such as KeyboardInterrupt. The
/// exception ends a study, and is raised unchanged in Python.
class PluginInterrupt : public RunError {
 public:
  PluginInterrupt(const std::string& message, Kept cause)
      : RunError(message), cause_(std::move(cause)) {}

  [[nodiscard]] const Kept& cause() const { return cause_; }

 private:
  Kept cause_;
};

/// A key of a plug-in: a keyword parameter of the user's function.
struct PluginKey {
  enum class Type { kNumber, kOptionalNumber, kWhole, kFlag, kText, kNumbers };

  std::string name;
  std::string unit;
  std::string text;
  Type type = Type::kNumber;
  bool required = false;
  Range range{};
  Names allowed{};
};

/// The value of a key; only the member of the key's type is used.
struct PluginValue {
  double number = 0.0;
  std::optional<double> optional_number{};
  int whole = 0;
  bool flag = false;
  std::string text{};
  std::vector<double> numbers{};
};

/// A registered plug-in.
struct Plugin {
  std::string kind;     ///< "planner", "controller", "plant" or "metric".
  std::string name;     ///< Name in scenarios.
  std::string summary;  ///< One-line description.
  std::string place;    ///< Module and qualified name of the user's function.
  Kept adapter;         ///< Object of _plugins.py.
  std::vector<PluginKey> keys{};
  std::vector<PluginValue> defaults{};
};

/// The values of the keys of a plug-in. The options refer to the version of the plug-in with which
/// they were made, even if the plug-in is replaced later.
struct PluginOptions {
  std::shared_ptr<const Plugin> plugin{};
  std::vector<PluginValue> values{};
};

/// Visits the keys of a plug-in. Options without a plug-in get `current` and its default values.
void VisitPlugin(KeyVisitor& keys, const std::shared_ptr<const Plugin>& current,
                 PluginOptions& options);

/// Returns the values as keyword arguments. Requires the GIL.
py::dict KeywordsOf(const PluginOptions& options);

/// Reads a plug-in from the dictionary that _signatures.py passes. Requires the GIL.
std::shared_ptr<const Plugin> ReadPlugin(const py::dict& given);

/// Throws a Python exception if a function of the package runs on another thread, or if this thread
/// is inside of a plug-in.
void RequireNothingRuns(const Plugin& plugin);

/// Whether this thread is inside of a plug-in.
bool InsidePlugin();

/// Makes the exceptions of plug-ins printed with their tracebacks, as the program does.
void PrintTracebacks();

/// Counts how often this thread has entered plug-ins.
class PluginCall {
 public:
  PluginCall();
  PluginCall(const PluginCall&) = delete;
  PluginCall& operator=(const PluginCall&) = delete;
  ~PluginCall();
};

/// Throws the present Python exception as PluginError or PluginInterrupt. Requires the GIL.
[[noreturn]] void ThrowPluginError(const Plugin& plugin, py::error_already_set& error);

/// Calls `call`, which calls the plug-in and converts its results, with the GIL. The result must
/// not refer to Python objects.
template <typename Call>
auto Ask(const Plugin& plugin, const Call& call) {
  const py::gil_scoped_acquire gil;
  const PluginCall inside;
  try {
    return call();
  } catch (py::error_already_set& error) {
    ThrowPluginError(plugin, error);
  }
}

/// Converts numbers that an adapter returned.
std::vector<double> ToNumbers(const py::handle& numbers);

void RegisterPythonPlanner(const py::dict& given);
void RegisterPythonController(const py::dict& given);
void RegisterPythonPlant(const py::dict& given);
void RegisterPythonMetric(const py::dict& given);
void BindPlannerRequest(py::module_& module);
void BindControllerInput(py::module_& module);
void BindPlantSetup(py::module_& module);

}  // namespace trackbed::python
