#include "trackbed/planning/common/plan.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

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

/// "-" for what a plan does not tell.
std::string Number(const nlohmann::json& turn, const nlohmann::json::json_pointer& key,
                   const char* format) {
  return turn.contains(key) && turn[key].is_number()
             ? fmt::format(fmt::runtime(format), turn[key].get<double>())
             : "-";
}

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line + "|");
  for (std::string cell; std::getline(in, cell, '|');) {
    cells.push_back(cell);
  }
  return cells;
}

/// One line of the table of turns.
void PrintRow(const std::vector<std::string>& cells) {
  constexpr std::array kWidths{8, 8, 8, 8, 6, 14, 6, 7, 8, 8, 11, 9, 8};
  std::string line = " ";
  for (std::size_t i = 0; i < kWidths.size(); ++i) {
    line += fmt::format(" {:>{}}", cells[i], kWidths[i]);
  }
  fmt::print("{}\n", line);
}

/// The turns of plan.json, one line each.
void PrintTurns(const nlohmann::json& diagnostics) {
  using Pointer = nlohmann::json::json_pointer;
  if (!diagnostics.contains("turns") || diagnostics["turns"].empty()) {
    return;
  }
  for (const char* line : {"waypoint|angle|first r|radius|speed|constraint|ramp|ramp|steer|return|"
                           "evaluations|objective|deficit",
                           "|[rad]|[m]|[m]|[m/s]||[s]|[m]|from [m]|from [m]|||[rad]"}) {
    PrintRow(Split(line));
  }
  for (const nlohmann::json& turn : diagnostics["turns"]) {
    const auto number = [&](const char* key, const char* format) {
      return Number(turn, Pointer(key), format);
    };
    PrintRow({fmt::format("{}", turn["waypoint"].get<int>()),
              number("/heading_change_rad", "{:.4f}"), number("/search/first_radius_m", "{:.4f}"),
              number("/radius_m", "{:.4f}"), number("/speed_mps", "{:.3f}"),
              turn["active_constraint"].get<std::string>(), number("/ramp_time_s", "{:.3f}"),
              number("/ramp_distance_m", "{:.3f}"), number("/steer_start_m", "{:.3f}"),
              number("/steer_return_m", "{:.3f}"), number("/search/evaluations", "{:.0f}"),
              number("/search/objective", "{:.2e}"),
              number("/predicted/heading_deficit_rad", "{:.5f}")});
    if (turn["ramp_truncated"].get<bool>()) {
      fmt::print(
          "           ramp truncated: the wheels return before they reach the arc's angle\n");
    }
    if (turn.contains("note")) {
      fmt::print("           {}\n", turn["note"].get<std::string>());
    }
  }
  if (diagnostics.contains("neutral_steering_rad")) {
    fmt::print("  between turns: steering angle {:.4g} rad, kinematic curvature {:.4g} 1/m\n",
               diagnostics["neutral_steering_rad"].get<double>(),
               diagnostics["neutral_curvature_radpm"].get<double>());
  }
  fmt::print(
      "  open loop, kinematic: goal distance {} m, goal heading error {} rad, maximum deviation {} "
      "m\n",
      Number(diagnostics, Pointer("/open_loop/goal_distance_m"), "{:.4f}"),
      Number(diagnostics, Pointer("/open_loop/goal_heading_error_rad"), "{:.5f}"),
      Number(diagnostics, Pointer("/open_loop/deviation_max_m"), "{:.4f}"));
}

/// The stretches that lead around obstacles, one line each.
void PrintAvoided(const Plan& plan) {
  if (plan.diagnostics.contains("avoid")) {
    for (const nlohmann::json& stretch : plan.diagnostics["avoid"]) {
      fmt::print(
          "  passes the obstacle at ({:.4g}, {:.4g}) on the {} side: clearance {:.3f} m, from "
          "{:.2f} m to {:.2f} m, maximum steering {:.4f} rad and {:.4f} rad/s\n",
          stretch["obstacle_m"][0].get<double>(), stretch["obstacle_m"][1].get<double>(),
          stretch["ring"].get<std::string>(), stretch["clearance_m"].get<double>(),
          stretch["leave_s_m"].get<double>(), stretch["return_s_m"].get<double>(),
          stretch["steering_max_rad"].get<double>(),
          stretch["steering_rate_max_radps"].get<double>());
    }
  }
  if (!plan.blocked.empty()) {
    fmt::print("  {}\n", plan.blocked);
  }
  if (!plan.partial.empty()) {
    fmt::print("  partial: {}\n", plan.partial);
  }
}

int PlanOne(const PlanOptions& options) {
  const Scenario scenario = options.scenario.Read(options.file);
  if (!scenario.plan) {
    throw InputError(Problem{options.file, 0, 0, "plan", "missing; 'trackbed plan' needs one"});
  }
  const fs::path out =
      options.out.empty() ? fs::path("out") / scenario.name : fs::path(options.out);
  MakeFolder(out);
  const CarModel car = LoadCar(scenario);
  const Plan plan = PlanMission(scenario, car.unladen());
  if (!plan.ok()) {
    std::error_code ignored;
    for (const char* name : {"plan.csv", "schedule.csv", "convergence.csv", "tree.csv"}) {
      fs::remove(out / name, ignored);  // of an earlier plan
    }
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
    PrintTurns(plan.diagnostics);
    PrintAvoided(plan);
  }
  return kOk;
}

}  // namespace

void AddPlan(const Command& command) {
  const auto options = std::make_shared<PlanOptions>();
  command.AddPositional("file", options->file, "Scenario file").Required().TypeName("FILE");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<scenario>)")
      .TypeName("DIR");
  options->scenario.AddTo(command);
  command.OnRun([options] { return PlanOne(*options); });
}

}  // namespace trackbed::cli
