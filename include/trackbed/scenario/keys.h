#pragma once

#include <string>
#include <vector>

/// Lists all keys of scenarios, studies and log maps. The same code lists the keys and reads them
/// from files.
namespace trackbed {

struct KeyInfo {
  std::string name;  ///< Name of the key within its section.
  std::string type;  ///< Type of the value, such as "number", "list of names" or "section".
  /// Unit of the value, such as "m/s"; empty if the key is not a physical quantity.
  std::string unit;
  std::string fallback;  ///< Default value; empty if the key has no default.
  /// Allowed values, such as "above 0 and at most 10"; empty if all values of the type are allowed.
  std::string allowed;
  std::string text;  ///< One-line description.
  bool required = false;
};

struct KeySection {
  /// Dotted key of the section, in which N stands for the index of a list element; empty for the
  /// whole file.
  std::string key;
  /// Name of the method to which the section's keys belong; empty if the keys apply to all methods.
  std::string method;
  std::string text;  ///< One-line description.
  std::vector<KeyInfo> keys;
};

/// Returns the sections of keys of a scenario, in the order of the file. Each section is listed
/// before the sections that it contains.
std::vector<KeySection> ScenarioKeys();

/// Returns the sections of keys of a study file.
std::vector<KeySection> StudyKeys();

/// Returns the sections of keys of a log map (recording/log_map.h).
std::vector<KeySection> LogMapKeys();

/// Returns the sections of keys of an identification study.
std::vector<KeySection> IdentificationKeys();

}  // namespace trackbed
