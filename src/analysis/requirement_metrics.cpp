#include "trackbed/analysis/requirement_metrics.h"

#include <fmt/format.h>

#include "trackbed/core/error.h"
#include "trackbed/requirement/formula.h"

namespace trackbed {
namespace {

RequirementMetrics MeasureOnTable(const RequirementExpectation& requirement, const Table& log) {
  RequirementMetrics metrics{.name = requirement.name, .formula = requirement.formula};
  try {
    const FormulaResult result = Evaluate(Formula::Parse(requirement.formula, log.columns()), log);
    if (!result.row) {
      const std::vector<double> times = log.Column("t_s");
      metrics.problem = fmt::format(
          "no sample decides it: its windows begin after the end of the log, {:.4g} s long",
          times.back() - times.front());
      return metrics;
    }
    metrics.robustness = result.robustness;
    metrics.satisfied = result.satisfied;
    metrics.s = log.Column("s_m")[*result.row];
    metrics.t = log.Column("t_s")[*result.row];
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    metrics.problem = problem.column > 0 ? fmt::format("column {} of the formula: {}",
                                                       problem.column, problem.message)
                                         : problem.message;
  }
  return metrics;
}

}  // namespace

RequirementMetrics MeasureRequirement(const RequirementExpectation& requirement,
                                      const RunLog& log) {
  return MeasureOnTable(requirement, ToTable(log));
}

std::vector<RequirementMetrics> MeasureRequirements(const Expectations& expect, const RunLog& log) {
  std::vector<RequirementExpectation> own = expect.all.requirements;
  for (const auto& [plant, expectation] : expect.plants) {
    if (plant == log.plant) {
      own.insert(own.end(), expectation.requirements.begin(), expectation.requirements.end());
    }
  }
  std::vector<RequirementMetrics> metrics;
  if (!own.empty()) {
    const Table table = ToTable(log);
    for (const RequirementExpectation& requirement : own) {
      metrics.push_back(MeasureOnTable(requirement, table));
    }
  }
  return metrics;
}

std::string RequirementPath(const std::string& name) {
  return fmt::format("requirements.{}.robustness", name);
}

}  // namespace trackbed
