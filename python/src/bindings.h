#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "python/src/threads.h"
#include "trackbed/analysis/run.h"

/// Shared parts of the compiled module _trackbed, on which the Python files of the package build.
/// All functions that simulate, plan, render, read or write files run without the GIL.
namespace trackbed::python {

namespace py = pybind11;

/// A table of numbers, column by column, whose columns Python reads as arrays.
class Columns {
 public:
  explicit Columns(const Table& table);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Returns a column, whose memory is constant as long as this object exists (nullptr for a table
  /// without rows); nullopt if the table has no such column.
  [[nodiscard]] std::optional<const double*> Find(const std::string& name) const;

 private:
  std::vector<std::string> names_;
  std::size_t rows_;
  std::vector<double> cells_;  // One column after the other.
};

/// Converts JSON to dictionaries, lists, numbers and texts.
py::object ToPython(const nlohmann::ordered_json& json);

/// Makes a copy the object itself, for a class whose objects do not change.
template <typename Class>
void CopyAsItself(Class& bound) {
  bound.def("__copy__", [](const py::object& self) { return self; });
  bound.def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; });
}

/// Asks Python about once in 20 ms, while a run is simulated or filmed without the GIL, whether a
/// signal such as Ctrl-C has arrived. Only the main thread of Python handles signals. The end of
/// the interpreter counts as a signal for the other threads.
class Signals {
 public:
  /// Returns whether a signal handler has raised an exception, such as KeyboardInterrupt, or the
  /// interpreter ends.
  bool Raised();
  /// Throws the exception of the signal handler if there was one. Requires the GIL.
  void Rethrow();

 private:
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
  std::shared_ptr<py::error_already_set> error_;
};

/// Returns the cars that all runs and loops of the process share.
CarCache& Cars();

void BindErrors(py::module_& module);
void BindRuns(py::module_& module);
void BindChecks(py::module_& module);
void BindPictures(py::module_& module);
void BindLoops(py::module_& module);
void BindPlugins(py::module_& module);
void BindSweeps(py::module_& module);
void BindProgram(py::module_& module);

}  // namespace trackbed::python
