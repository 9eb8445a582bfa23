#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "python/src/bindings.h"
#include "trackbed/analysis/run_checks.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/core/error.h"
#include "trackbed/requirement/formula.h"

namespace trackbed::python {
namespace {

/// Throws an InputError that names the argument `formula` if it is no formula over the columns of a
/// log. The matcher of GoogleTest counts such a formula as a failed check.
void RequireFormula(const RunResult& run, const std::string& formula) {
  try {
    for (const RunLog& log : run.logs) {
      Formula::Parse(formula, ToTable(log).columns());
    }
  } catch (const InputError& error) {
    throw InputError(Problem{.message = fmt::format("formula is '{}': {}", formula, error.what())});
  }
}

}  // namespace

void BindChecks(py::module_& module) {
  using run_checks::RunCheck;
  py::class_<RunCheck>(module, "RunCheck")
      .def_readonly("description", &RunCheck::description)
      .def("failures", [](const RunCheck& check, const RunResult& run) {
        return run_checks::Failures(check, run);
      });
  module.def("tracks_within", &run_checks::TracksWithin);
  module.def("stays_within", &run_checks::StaysWithin);
  module.def("keeps_clearance", &run_checks::KeepsClearance);
  module.def("reaches_goal", &run_checks::ReachesGoal);
  module.def("steers_calmly", &run_checks::SteersCalmly);
  module.def("require_formula", &RequireFormula);
  module.def("satisfies", &run_checks::Satisfies);
  module.def("meets_its_expectations", &run_checks::MeetsItsExpectations);
  module.def("describe", [](const RunResult& run) { return run_checks::Describe(run); });

  py::class_<PlantComparison>(module, "PlantComparison")
      .def_property_readonly("values", [](const PlantComparison& c) { return ToPython(ToJson(c)); })
      .def_property_readonly("description",
                             [](const PlantComparison& c) { return run_checks::Describe(c); })
      .def("exceeded", [](const PlantComparison& comparison,
                          const std::map<std::string, std::optional<double>>& limits) {
        DifferenceBounds bounds;
        for (const ComparedQuantity& quantity : ComparedQuantities()) {
          const auto limit = limits.find(quantity.key);
          bounds.*quantity.bound = limit == limits.end() ? std::nullopt : limit->second;
        }
        return std::pair(run_checks::Describe(bounds), Exceeded(bounds, comparison));
      });
  module.def("compare", [](const RunResult& run, const std::string& first,
                           const std::string& second) { return Compare(run, first, second); });
  module.def("compare_runs",
             [](const RunResult& first, const RunResult& second, const std::string& plant) {
               return Compare(first, second, plant);
             });
}

}  // namespace trackbed::python
