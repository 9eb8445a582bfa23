#include "trackbed/planning/common/plan.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "src/cli/diagnostics_text.h"
#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/waypoint_miss.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct PlanOptions {
  std::string file;
  std::string out;
  ScenarioOptions scenario;
};

int RunPlanVerb(const PlanOptions& options) {
  const Scenario scenario = options.scenario.Read(options.file);
  if (!scenario.plan) {
    throw InputError(Problem{options.file, 0, 0, "plan", "missing; 'trackbed plan' needs one"});
  }
  const fs::path out = OutputFolderOf(options.out, scenario.name);
  const CarModel car = LoadCar(scenario);
  RefuseOverlapAtStart(options.file, scenario, car.params());
  const OutputFolder folder(out, FileNamesOfVerb("plan"));
  const RunResult planned = PlanRun(scenario, car);
  const Plan& plan = planned.plan;
  WritePlan(planned, folder);
  if (!plan.ok()) {
    PrintTo(stderr, "{}: no plan ({}): {}\n", scenario.name, ToString(plan.status), plan.reason);
    return kFailedExpectations;
  }
  if (!options.scenario.quiet) {
    const double length = plan.reference.path.length();
    Print("{}: planned {:.3f} m in {:.2f} s, in {}\n", scenario.name, length, plan.Duration(),
          out.string());
    Print("{}", Lines{DiagnosticsText(plan)});
    if (const auto miss = LargestWaypointMiss(plan.reference.path, plan.waypoints)) {
      Print("  largest distance from a waypoint: {:.4g} m ({})\n", miss->distance,
            DescribeWaypoint(miss->waypoint, miss->at));
    }
    if (!plan.partial.empty()) {
      Print("  partial: {}\n", plan.partial);
    }
    for (const std::string& note : plan.notes) {
      Print("  note: {}\n", note);
    }
  }
  return kOk;
}

}  // namespace

void AddPlan(const Command& command) {
  const auto options = std::make_shared<PlanOptions>();
  command.AddPositional("file", options->file, "Scenario file").Required().TypeName("SCENARIO");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<scenario>)")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.AddExample("Plan one of the shipped scenarios", "trackbed plan winding");
  command.OnRun([options] { return RunPlanVerb(*options); });
}

}  // namespace trackbed::cli
