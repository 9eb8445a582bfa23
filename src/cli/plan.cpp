#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct PlanOptions {
  std::string file;
  std::string out;
  ScenarioOptions scenario;
};

int PlanOne(const PlanOptions& options) {
  const Scenario scenario = options.scenario.Read(options.file);
  if (!scenario.plan) {
    throw InputError(Problem{options.file, 0, 0, "plan", "missing; there is nothing to plan"});
  }
  const fs::path out =
      options.out.empty() ? fs::path("out") / scenario.name : fs::path(options.out);
  MakeFolder(out);
  const CarModel car = LoadCar(scenario);
  const Plan plan = PlanMission(scenario, car.params());
  if (!plan.ok()) {
    std::error_code ignored;
    fs::remove(out / "plan.csv", ignored);  // of an earlier plan
  }
  WritePlan(plan, scenario, out);
  if (!plan.ok()) {
    fmt::print(stderr, "{}: no plan ({}): {}\n", scenario.name, ToString(plan.status), plan.reason);
    return kFailedExpectations;
  }
  if (!options.scenario.quiet) {
    const double length = plan.reference.path.length();
    fmt::print("{}: planned {:.3f} m in {:.2f} s, in {}\n", scenario.name, length,
               plan.reference.speed.TimeAt(length), out.string());
  }
  return kOk;
}

}  // namespace

void AddPlan(CLI::App& command, int& exit_code) {
  const auto options = std::make_shared<PlanOptions>();
  command.add_option("file", options->file, "Scenario file")->required()->type_name("FILE");
  command.add_option("-o,--out", options->out, "Folder to write to (default: out/<scenario>)")
      ->type_name("DIR");
  options->scenario.AddTo(command);
  command.callback([options, &exit_code] { exit_code = PlanOne(*options); });
}

}  // namespace trackbed::cli
