#include "trackbed/analysis/requirement_metrics.h"

#include <fmt/format.h>

#include "trackbed/core/error.h"
#include "trackbed/requirement/robustness.h"

namespace trackbed {
namespace {

/// Returns the log with positions in the coordinates of the scenario's file, in which formulas are
/// written.
Table TableOf(const RunLog& log) {
  const Table local = ToTable(log);
  if (log.origin == Vec2::Zero()) {
    return local;
  }
  std::vector<double> added(local.columns().size(), 0.0);
  for (std::size_t column = 0; column < added.size(); ++column) {
    const std::string& name = local.columns()[column];
    added[column] = name == "x_m" || name == "measured_x_m"   ? log.origin.x()
                    : name == "y_m" || name == "measured_y_m" ? log.origin.y()
                                                              : 0.0;
  }
  Table table(local.columns());
  std::vector<double> cells(added.size());
  for (std::size_t row = 0; row < local.rows(); ++row) {
    for (std::size_t column = 0; column < added.size(); ++column) {
      cells[column] = local.at(row, column) + added[column];
    }
    table.AddRow(cells);
  }
  return table;
}

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
  return MeasureOnTable(requirement, TableOf(log));
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
    const Table table = TableOf(log);
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
