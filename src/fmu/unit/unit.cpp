#include "src/fmu/unit/unit.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "src/fmu/resources.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/text_table.h"

// The behavior of an FMU, independent of the version of FMI.
// 1. The resources of the FMU contain the scenario and all files that the scenario names.
// 2. Parameters of the FMU override numbers of the scenario. When the host exits the initialization
//    mode, the FMU plans the mission and makes the loop. The exit from the initialization mode
//    fails if planning fails.
// 3. Step advances the loop by a whole number of control periods. Step counts the control periods,
//    so that rounding errors of the host's times do not accumulate.
// 4. Get returns values from the present log row, or from the present commands.
// 5. A saved state of the FMU is a copy of the control loop, to which the host can return.
namespace trackbed::fmu {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void Refuse(std::string message) {
  throw InputError(Problem{.message = std::move(message)});
}

std::map<std::string, std::string> ReadResources(const fs::path& folder) {
  std::map<std::string, std::string> resources;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    resources.emplace(entry->path().filename().string(), ReadFile(entry->path()));
  }
  if (error) {
    throw RunError(fmt::format("cannot read {}: {}", folder.string(), error.message()));
  }
  return resources;
}

const char* NameOf(Type type) {
  switch (type) {
    case Type::kReal:
      return "real";
    case Type::kInteger:
      return "integer";
    case Type::kBoolean:
      return "Boolean";
    case Type::kStatus:
      return "enumeration";
  }
  return "";
}

/// Returns commands with zero inputs and with the flags that the fixed Boolean parameters set.
Commands StartCommands(const std::map<std::uint32_t, double>& parameters) {
  return {.controller_steers = parameters.contains(kControllerSteers),
          .plan_sets_speed = parameters.contains(kPlanSetsSpeed)};
}

/// Reads the scenario, with the FMU's parameter values as overrides. Error messages about a
/// parameter name the key of the parameter, but no file, line or command line option.
Scenario ReadWithParameters(const fs::path& file, const std::vector<Override>& overrides) {
  try {
    return ReadScenario(file, overrides);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      problem.file.clear();
      problem.line = 0;
    }
    throw InputError(std::move(problems));
  }
}

std::string OverrideOf(const Variable& variable, double value) {
  const std::string text = variable.type == Type::kInteger
                               ? fmt::format("{}", static_cast<std::int64_t>(value))
                               : ShortestText(value);
  return variable.name + "=" + text;
}

}  // namespace

State State::Copy() const {
  State copy{.phase = phase,
             .start_time = start_time,
             .parameters = parameters,
             .commands = commands,
             .history = history,
             .loop = {}};
  if (loop) {
    copy.loop = loop->Copy();
  }
  return copy;
}

void StepOnce(SteppedLoop& loop, const Commands& commands) {
  if (commands.controller_steers) {
    loop.Step();
  } else {
    loop.Step(commands.steering,
              commands.plan_sets_speed ? std::nullopt : std::optional(commands.acceleration));
  }
}

Table PresentRow(const SteppedLoop& loop) {
  // Use the loop's present row, because the log ends with the last control period and does not
  // contain the present row yet.
  RunLog log = loop.log();
  log.rows = {loop.row()};
  return ToTable(log);
}

Unit::Unit(fs::path resources, std::string token, std::function<void(const std::string&)> warn)
    : resources_(std::move(resources)), token_(std::move(token)), warn_(std::move(warn)) {
  const std::map<std::string, std::string> files = ReadResources(resources_);
  if (const std::string own = TokenOf(files); own != token_) {
    Refuse(
        fmt::format("the instantiation token is '{}', but that of the files in {} is '{}'; take "
                    "both from one FMU",
                    token_, resources_.string(), own));
  }
  const Scenario scenario = ReadScenario(resources_ / kScenarioYaml);
  variables_ = Variables(files.at(kScenarioYaml), scenario);
  period_ = scenario.drive.control_period;
}

void Unit::EnterInitialization(double start) {
  if (state_.phase != Phase::kInstantiated) {
    Refuse("the initialization is only allowed after the instantiation or a reset");
  }
  if (!std::isfinite(start)) {
    Refuse(fmt::format("the start time is {}; must be finite", start));
  }
  state_.phase = Phase::kInitialization;
  state_.start_time = start;
}

SteppedLoop Unit::MakeLoop(const std::map<std::uint32_t, double>& parameters) const {
  std::vector<Override> overrides;
  for (const auto& [reference, value] : parameters) {
    if (reference >= kFirstParameter) {
      overrides.push_back(OverrideOf(variables_.at(reference), value));
    }
  }
  const auto scenario =
      std::make_shared<const Scenario>(ReadWithParameters(resources_ / kScenarioYaml, overrides));
  const auto car = std::make_shared<const CarModel>(LoadCar(*scenario));
  const FeasiblePlan plan = PlanScenario(*scenario, *car);
  if (!plan.ok()) {
    Refuse("no plan: " + plan->reason);
  }
  for (const std::string& note : plan->notes) {
    warn_(note);
  }
  return MakeSteppedLoop(scenario, car, plan, scenario->drive.plants.front(), /*keeps_log=*/false);
}

void Unit::MakeLoopIfNeeded() {
  if (!state_.loop) {
    state_.loop = MakeLoop(state_.parameters);
  }
}

void Unit::ExitInitialization() {
  if (state_.phase != Phase::kInitialization) {
    Refuse("the initialization has not begun, or has ended");
  }
  MakeLoopIfNeeded();
  state_.phase = Phase::kStepping;
}

void Unit::Terminate() {
  if (state_.phase != Phase::kStepping) {
    Refuse("only an initialized FMU can be terminated");
  }
  state_.phase = Phase::kTerminated;
}

void Unit::Reset() {
  state_ = {};
  outputs_.clear();
}

double Unit::Time() const {
  return state_.start_time + static_cast<double>(state_.history.size()) * period_;
}

StepEnd Unit::Step(double time, double step) {
  if (state_.phase != Phase::kStepping) {
    Refuse("a step is only allowed after the initialization and before the termination");
  }
  if (const auto& status = state_.loop->status()) {
    Refuse(
        fmt::format("the run ended at {} s ({}); end the simulation, reset the FMU, or restore "
                    "an earlier state",
                    Time(), ToString(*status)));
  }
  // The host's communication points and step sizes contain rounding errors, which grow with the
  // number of steps. The control loop counts periods, so rounding errors of the host's times do not
  // affect the simulation. The checks of the time and the step size accept rounding errors that are
  // too small to change the number of control periods.
  const double periods = std::round(step / period_);
  if (!(periods >= 1.0 && std::abs(step / period_ - periods) < 1e-6 * periods && periods < 1e9)) {
    Refuse(fmt::format("the step size is {} s; must be a multiple of the control period, {} s",
                       step, period_));
  }
  if (!(std::abs(time - Time()) < 0.5 * period_)) {
    Refuse(fmt::format("the step begins at {} s, but the FMU is at {} s", time, Time()));
  }
  outputs_.clear();
  for (auto left = static_cast<std::int64_t>(periods); left > 0 && !state_.loop->status(); --left) {
    StepOnce(*state_.loop, state_.commands);
    state_.history.push_back(state_.commands);
  }
  return Present();
}

StepEnd Unit::Present() const {
  return {.ended = state_.loop && state_.loop->status(), .time = Time()};
}

const Variable& Unit::Find(Type type, std::uint32_t reference) const {
  if (reference >= variables_.size()) {
    Refuse(fmt::format("there is no variable with the value reference {}; the largest is {}",
                       reference, variables_.size() - 1));
  }
  const Variable& variable = variables_[reference];
  // Accept integers for enumerations, because the C functions read and write an enumeration as an
  // integer.
  const bool fits =
      variable.type == type || (variable.type == Type::kStatus && type == Type::kInteger);
  if (!fits) {
    Refuse(fmt::format("{} is of the type {}, not {}", variable.name, NameOf(variable.type),
                       NameOf(type)));
  }
  return variable;
}

void Unit::Set(Type type, std::uint32_t reference, double value) {
  const Variable& variable = Find(type, reference);
  if (!std::isfinite(value)) {
    Refuse(fmt::format("{} is {}; must be finite", variable.name, value));
  }
  if (variable.causality == Causality::kInput) {
    if (state_.phase == Phase::kTerminated) {
      Refuse(fmt::format("{} cannot be set after the termination", variable.name));
    }
    (reference == kSteering ? state_.commands.steering : state_.commands.acceleration) = value;
    return;
  }
  if (variable.causality != Causality::kParameter) {
    Refuse(fmt::format("{} is an output, which cannot be set", variable.name));
  }
  if (state_.phase != Phase::kInstantiated && state_.phase != Phase::kInitialization) {
    Refuse(
        fmt::format("{} is a fixed parameter, which can only be set before the end of the "
                    "initialization",
                    variable.name));
  }
  if (value == variable.start) {
    state_.parameters.erase(reference);
  } else {
    state_.parameters[reference] = value;
  }
  const Commands start = StartCommands(state_.parameters);
  state_.commands.controller_steers = start.controller_steers;
  state_.commands.plan_sets_speed = start.plan_sets_speed;
  // Discard the control loop. The next call that needs the loop plans the mission again and makes a
  // new loop.
  state_.loop.reset();
  outputs_.clear();
}

double Unit::Get(Type type, std::uint32_t reference) {
  const Variable& variable = Find(type, reference);
  switch (variable.causality) {
    case Causality::kIndependent:
      return Time();
    case Causality::kInput:
      return reference == kSteering ? state_.commands.steering : state_.commands.acceleration;
    case Causality::kParameter: {
      const auto set = state_.parameters.find(reference);
      return set == state_.parameters.end() ? variable.start : set->second;
    }
    case Causality::kOutput:
      break;
  }
  if (state_.phase == Phase::kInstantiated) {
    Refuse(
        fmt::format("{} is an output, which is known from the initialization on", variable.name));
  }
  MakeLoopIfNeeded();
  if (reference == kStatus) {
    const auto& status = state_.loop->status();
    return status ? kRunning + 1 + static_cast<int>(*status) : kRunning;
  }
  if (outputs_.empty()) {
    const Table row = PresentRow(*state_.loop);
    for (std::size_t column = 0; column < row.columns().size(); ++column) {
      outputs_[row.columns()[column]] = row.at(0, column);
    }
  }
  // Return NaN if the log lacks the variable's column, which a parameter such as the pose noise may
  // have removed.
  const auto found = outputs_.find(variable.name);
  return found == outputs_.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

void Unit::Restore(const State& state) {
  state_ = state.Copy();
  outputs_.clear();
}

}  // namespace trackbed::fmu
