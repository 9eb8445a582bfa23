#include "src/fmu/model_description.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/version.h"

// Writes modelDescription.xml of an FMU, for FMI 2 and FMI 3.
// 1. ParseUnit splits units such as "m/s^2" into powers of SI base units, which FMI requires.
// 2. Variables are written in the order of their value references. The XML elements and the names
//    of causality and variability differ between FMI 2 and FMI 3.
// 3. AddStructure lists the outputs and the variables that are unknown at initialization.
// Source: FMI 2.0.4, section 2.2; FMI 3.0.1, section 2.4.
namespace trackbed::fmu {
namespace {

using tinyxml2::XMLElement;

/// A unit as a factor times a product of powers of SI base units.
struct BaseUnits {
  std::map<std::string, int> exponents{};
  double factor = 1.0;
};

/// Multiplies the unit `base` by `unit` to the power `exponent`; `unit` is a single unit, such as
/// "N". Returns false for an unknown unit.
bool Multiply(std::string_view unit, int exponent, BaseUnits& base) {
  using Exponents = std::map<std::string, int>;
  static const std::map<std::string_view, std::pair<Exponents, double>> kKnown{
      {"m", {{{"m", 1}}, 1.0}},
      {"s", {{{"s", 1}}, 1.0}},
      {"kg", {{{"kg", 1}}, 1.0}},
      {"rad", {{{"rad", 1}}, 1.0}},
      {"deg", {{{"rad", 1}}, std::numbers::pi / 180.0}},
      {"Hz", {{{"s", -1}}, 1.0}},
      {"N", {{{"kg", 1}, {"m", 1}, {"s", -2}}, 1.0}}};
  const auto known = kKnown.find(unit);
  if (known == kKnown.end()) {
    return unit == "1";
  }
  for (const auto& [name, own] : known->second.first) {
    base.exponents[name] += own * exponent;
  }
  base.factor *= std::pow(known->second.second, exponent);
  return true;
}

/// Parses a unit such as "m/s^2", "N s" or "1/m"; returns nullopt if the unit cannot be parsed.
std::optional<BaseUnits> ParseUnit(const std::string& unit) {
  BaseUnits base;
  int sign = 1;
  for (std::size_t begin = 0; begin < unit.size();) {
    const std::size_t end = std::min(unit.find_first_of(" /", begin), unit.size());
    std::string_view word = std::string_view(unit).substr(begin, end - begin);
    int exponent = 1;
    if (const std::size_t power = word.find('^'); power != std::string_view::npos) {
      exponent = word.back() - '0';
      word = word.substr(0, power);
    }
    if (!Multiply(word, sign * exponent, base)) {
      return std::nullopt;
    }
    sign = end < unit.size() && unit[end] == '/' ? -1 : sign;
    begin = end + 1;
  }
  return base;
}

void AddUnits(XMLElement& root, const std::vector<Variable>& variables) {
  std::set<std::string> units;
  for (const Variable& variable : variables) {
    units.insert(variable.unit);
  }
  XMLElement& list = *root.InsertNewChildElement("UnitDefinitions");
  for (const std::string& unit : units) {
    if (unit.empty()) {
      continue;
    }
    XMLElement& element = *list.InsertNewChildElement("Unit");
    element.SetAttribute("name", unit.c_str());
    if (const std::optional<BaseUnits> base = ParseUnit(unit)) {
      XMLElement& definition = *element.InsertNewChildElement("BaseUnit");
      for (const auto& [name, exponent] : base->exponents) {
        if (exponent != 0) {
          definition.SetAttribute(name.c_str(), exponent);
        }
      }
      if (base->factor != 1.0) {
        definition.SetAttribute("factor", ShortestText(base->factor).c_str());
      }
    }
  }
}

void AddStatusType(XMLElement& root, FmiVersion version) {
  XMLElement& list = *root.InsertNewChildElement("TypeDefinitions");
  XMLElement* type = nullptr;
  if (version == FmiVersion::k3) {
    type = list.InsertNewChildElement("EnumerationType");
    type->SetAttribute("name", "Status");
  } else {
    XMLElement* simple = list.InsertNewChildElement("SimpleType");
    simple->SetAttribute("name", "Status");
    type = simple->InsertNewChildElement("Enumeration");
  }
  int value = kRunning;
  for (const std::string& name : StatusNames()) {
    XMLElement& item = *type->InsertNewChildElement("Item");
    item.SetAttribute("name", name.c_str());
    item.SetAttribute("value", value++);
  }
}

const char* ElementName(const Variable& variable, FmiVersion version) {
  const bool is_3 = version == FmiVersion::k3;
  switch (variable.type) {
    case Type::kReal:
      return is_3 ? "Float64" : "Real";
    case Type::kInteger:
      return is_3 ? "Int64" : "Integer";
    case Type::kBoolean:
      return "Boolean";
    case Type::kStatus:
      return "Enumeration";
  }
  return "";
}

const char* CausalityName(Causality causality) {
  switch (causality) {
    case Causality::kIndependent:
      return "independent";
    case Causality::kInput:
      return "input";
    case Causality::kParameter:
      return "parameter";
    case Causality::kOutput:
      return "output";
  }
  return "";
}

/// Returns the FMI variability of a variable. Commands take effect at the start of a control
/// period, so the variables of commands are discrete.
const char* VariabilityName(const Variable& variable) {
  switch (variable.causality) {
    case Causality::kParameter:
      return "fixed";
    case Causality::kInput:
      return "discrete";
    case Causality::kIndependent:
    case Causality::kOutput:
      break;
  }
  return variable.type == Type::kReal ? "continuous" : "discrete";
}

std::string StartText(const Variable& variable) {
  return variable.type == Type::kBoolean ? (variable.start != 0.0 ? "true" : "false")
                                         : ShortestText(variable.start);
}

/// Throws InputError if FMI 2 has no integer for the start value of a variable.
void RequireInteger(const Variable& variable) {
  if (variable.type == Type::kInteger &&
      std::abs(variable.start) > std::numeric_limits<std::int32_t>::max()) {
    throw InputError(Problem{.key = variable.name,
                             .message = fmt::format("is {}; integers of FMI 2 are at most {}; use "
                                                    "--fmi 3",
                                                    ShortestText(variable.start),
                                                    std::numeric_limits<std::int32_t>::max())});
  }
}

void AddVariable(XMLElement& list, const Variable& variable, std::uint32_t reference,
                 FmiVersion version) {
  const bool is_3 = version == FmiVersion::k3;
  if (!is_3) {
    RequireInteger(variable);
  }
  XMLElement& element =
      *list.InsertNewChildElement(is_3 ? ElementName(variable, version) : "ScalarVariable");
  element.SetAttribute("name", variable.name.c_str());
  element.SetAttribute("valueReference", reference);
  element.SetAttribute("causality", CausalityName(variable.causality));
  element.SetAttribute("variability", VariabilityName(variable));
  if (!variable.text.empty()) {
    element.SetAttribute("description", variable.text.c_str());
  }
  XMLElement& type =
      is_3 ? element : *element.InsertNewChildElement(ElementName(variable, version));
  if (variable.type == Type::kStatus) {
    type.SetAttribute("declaredType", "Status");
  }
  if (!variable.unit.empty()) {
    type.SetAttribute("unit", variable.unit.c_str());
  }
  if (variable.causality == Causality::kInput || variable.causality == Causality::kParameter) {
    type.SetAttribute("start", StartText(variable).c_str());
  }
}

/// Adds the element ModelStructure, which lists the outputs. No output depends directly on an
/// input, because a command changes only the motion after the present time.
void AddStructure(XMLElement& root, const std::vector<Variable>& variables, FmiVersion version) {
  const bool is_3 = version == FmiVersion::k3;
  XMLElement& structure = *root.InsertNewChildElement("ModelStructure");
  const auto list = [&](const char* name) -> XMLElement& {
    return is_3 ? structure : *structure.InsertNewChildElement(name);
  };
  const auto add = [&](XMLElement& in, const char* name, std::uint32_t reference) -> XMLElement& {
    XMLElement& element = *in.InsertNewChildElement(is_3 ? name : "Unknown");
    // Add 1 for FMI 2, which counts the variables from 1.
    element.SetAttribute(is_3 ? "valueReference" : "index", is_3 ? reference : reference + 1);
    return element;
  };
  std::vector<std::uint32_t> outputs;
  for (std::uint32_t i = 0; i < variables.size(); ++i) {
    if (variables[i].causality == Causality::kOutput) {
      outputs.push_back(i);
    }
  }
  XMLElement& all = list("Outputs");
  for (const std::uint32_t output : outputs) {
    add(all, "Output", output).SetAttribute("dependencies", "");
  }
  XMLElement& initial = list("InitialUnknowns");
  for (const std::uint32_t output : outputs) {
    add(initial, "InitialUnknown", output);
  }
}

void AddInterface(XMLElement& root, const Description& description, bool is_3) {
  XMLElement& interface = *root.InsertNewChildElement("CoSimulation");
  interface.SetAttribute("modelIdentifier", kModelIdentifier);
  interface.SetAttribute("canHandleVariableCommunicationStepSize", "true");
  if (is_3) {
    interface.SetAttribute("fixedInternalStepSize",
                           ShortestText(description.control_period).c_str());
  }
  interface.SetAttribute(is_3 ? "canGetAndSetFMUState" : "canGetAndSetFMUstate", "true");
  interface.SetAttribute(is_3 ? "canSerializeFMUState" : "canSerializeFMUstate", "true");
}

}  // namespace

std::string ModelDescription(const Description& description, const std::vector<Variable>& variables,
                             FmiVersion version) {
  const bool is_3 = version == FmiVersion::k3;
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement& root = *document.NewElement("fmiModelDescription");
  document.InsertEndChild(&root);
  root.SetAttribute("fmiVersion", is_3 ? "3.0" : "2.0");
  root.SetAttribute("modelName", description.name.c_str());
  root.SetAttribute(is_3 ? "instantiationToken" : "guid", description.token.c_str());
  root.SetAttribute("generationTool", fmt::format("Trackbed {}", Version()).c_str());
  root.SetAttribute("variableNamingConvention", "flat");
  AddInterface(root, description, is_3);
  AddUnits(root, variables);
  AddStatusType(root, version);
  XMLElement& categories = *root.InsertNewChildElement("LogCategories");
  for (const char* category : {"logStatusWarning", "logStatusError"}) {
    categories.InsertNewChildElement("Category")->SetAttribute("name", category);
  }
  XMLElement& experiment = *root.InsertNewChildElement("DefaultExperiment");
  experiment.SetAttribute("startTime", "0");
  experiment.SetAttribute("stepSize", ShortestText(description.control_period).c_str());
  XMLElement& list = *root.InsertNewChildElement("ModelVariables");
  for (std::uint32_t i = 0; i < variables.size(); ++i) {
    AddVariable(list, variables[i], i, version);
  }
  AddStructure(root, variables, version);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace trackbed::fmu
