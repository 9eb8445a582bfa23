#include "python/src/bindings.h"
#include "trackbed/core/error.h"
#include "trackbed/core/version.h"

namespace trackbed::python {

void BindErrors(py::module_& module) {
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<PreconditionError>(module, "PreconditionError", PyExc_ValueError);
  py::register_exception<RunError>(module, "RunError", PyExc_RuntimeError);
  py::register_exception<InternalError>(module, "InternalError", PyExc_RuntimeError);
}

}  // namespace trackbed::python

PYBIND11_MODULE(_trackbed, module) {
  using namespace trackbed::python;
  module.doc() = "Compiled part of the package trackbed; use the package instead.";
  module.attr("version") = trackbed::Version();
  BindErrors(module);
  BindRuns(module);
  BindChecks(module);
  BindPictures(module);
  BindLoops(module);
  BindPlugins(module);
  BindSweeps(module);
  BindProgram(module);
}
