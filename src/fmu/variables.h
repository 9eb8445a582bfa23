#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The variables of an FMU. The exporter writes the variables to modelDescription.xml. The shared
/// library creates an equal list from the scenario in the FMU.
namespace trackbed::fmu {

enum class Type { kReal, kInteger, kBoolean, kStatus };
enum class Causality { kIndependent, kInput, kParameter, kOutput };

struct Variable {
  std::string name;
  Type type = Type::kReal;
  Causality causality = Causality::kOutput;
  std::string unit{};  ///< Unit such as "m/s"; empty if dimensionless.
  std::string text{};  ///< One-line description.
  double start = 0.0;  ///< Start value of an input or a parameter.
};

/// Value references of the variables that every FMU has. A value reference is an index into the
/// list of variables.
enum Reference : std::uint32_t {
  kTime = 0,
  kSteering = 1,
  kAcceleration = 2,
  kControllerSteers = 3,
  kPlanSetsSpeed = 4,
  kStatus = 5,
  kFirstParameter = 6,
};

/// File name of the scenario in the folder `resources` of an FMU.
inline constexpr const char* kScenarioYaml = "scenario.yaml";

/// Value of the output `status` while the run has not ended. After the end of the run, the output
/// `status` is 1 plus the number of the DriveStatus.
inline constexpr int kRunning = 0;
/// Returns the names of the values of the output `status`, from kRunning on.
std::vector<std::string> StatusNames();

/// Returns the variables of an FMU. The list begins with the variables of the enum Reference. The
/// remaining variables are a parameter for each number in `yaml` that influences the run, and the
/// log columns of the scenario's first plant. The argument `scenario` must be the scenario that
/// `yaml` describes.
std::vector<Variable> Variables(const std::string& yaml, const Scenario& scenario);

}  // namespace trackbed::fmu
