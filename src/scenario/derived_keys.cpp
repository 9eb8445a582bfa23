#include "src/scenario/derived_keys.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>

#include "src/scenario/study_settings.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

/// Characters allowed in the names that a formula uses; each name is a dotted key, possibly with
/// list indices.
constexpr const char* kNameCharacters =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.[]";

Problem PlacedAt(const Study& study, const DerivedKey& derived, std::string message) {
  return {study.file, derived.line, derived.column, "derive." + derived.key, std::move(message)};
}

/// Throws mu::ParserError unless the formula is an expression with a single value. RequireOneValue
/// is needed because muParser also evaluates lists such as "2, 3", and recognizes an assignment
/// only if the assigned name is defined.
void RequireOneValue(const std::string& formula, const std::vector<std::string>& names) {
  mu::Parser parser;
  parser.DefineNameChars(kNameCharacters);
  for (const std::string& name : names) {
    parser.DefineConst(name, 1.0);
  }
  parser.SetExpr(formula);
  int values = 0;
  parser.Eval(values);
  if (values != 1) {
    throw mu::ParserError(fmt::format("{} values with commas between them; must be one", values));
  }
}

/// Returns the keys that the formula of a derived key uses. NamesIn throws mu::ParserError if the
/// formula is invalid.
std::vector<std::string> NamesIn(const std::string& formula) {
  mu::Parser parser;
  parser.DefineNameChars(kNameCharacters);
  parser.SetExpr(formula);
  std::vector<std::string> names;
  for (const auto& [name, value] : parser.GetUsedVar()) {
    names.push_back(name);
  }
  RequireOneValue(formula, names);
  return names;
}

const Setting* Find(const std::vector<Setting>& settings, const std::string& key) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& setting) { return setting.key == key; });
  return found == settings.end() ? nullptr : &*found;
}

double Evaluate(const Study& study, const DerivedKey& derived,
                const std::vector<Setting>& settings) {
  mu::Parser parser;
  parser.DefineNameChars(kNameCharacters);
  for (const std::string& name : NamesIn(derived.formula)) {
    const Setting* setting = Find(settings, name);
    setting = setting == nullptr ? Find(study.set, name) : setting;
    if (setting == nullptr) {
      throw InputError(PlacedAt(study, derived, fmt::format("{} is not set at this point", name)));
    }
    const std::optional<double> number = NumberOf(setting->value);
    if (!number) {
      throw InputError(
          PlacedAt(study, derived, fmt::format("{} is {}, not a number", name, setting->value)));
    }
    parser.DefineConst(name, *number);
  }
  parser.SetExpr(derived.formula);
  try {
    return parser.Eval();
  } catch (const mu::ParserError& error) {
    throw InputError(PlacedAt(study, derived, error.GetMsg()));
  }
}

}  // namespace

void AddDerived(const Study& study, std::vector<Setting>& settings) {
  for (const DerivedKey& derived : study.derive) {
    const double value = Evaluate(study, derived, settings);
    if (!std::isfinite(value)) {
      throw InputError(
          PlacedAt(study, derived, fmt::format("'{}' is {} here", derived.formula, value)));
    }
    settings.push_back({derived.key, ShortestText(value), derived.line, derived.column});
  }
}

void CheckFormulas(const Study& study) {
  std::vector<std::string> known;
  for (const Setting& setting : study.set) {
    known.push_back(setting.key);
  }
  for (const Variation& variation : study.vary) {
    known.push_back(variation.key);
  }
  for (const auto& point : study.list) {
    for (const Setting& setting : point) {
      known.push_back(setting.key);
    }
  }
  std::vector<Problem> problems;
  for (const DerivedKey& derived : study.derive) {
    try {
      for (const std::string& name : NamesIn(derived.formula)) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
          problems.push_back(PlacedAt(
              study, derived,
              "uses a key that the study does not set before: " + UnknownName(name, known)));
        }
      }
    } catch (const mu::ParserError& error) {
      problems.push_back(PlacedAt(
          study, derived, fmt::format("'{}' is no formula: {}", derived.formula, error.GetMsg())));
    }
    known.push_back(derived.key);
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

}  // namespace trackbed
