#pragma once

#include <string>
#include <vector>

/// All keys of scenarios, studies and log maps, listed by the code that reads them.
namespace trackbed {

struct KeyInfo {
  std::string name;      ///< Name within the section.
  std::string type;      ///< Type: "number", "list of names", "section", …
  std::string unit;      ///< Unit such as "m/s"; empty for keys that are not quantities.
  std::string fallback;  ///< Default value; empty if the key has no default.
  /// Allowed values, "above 0 and at most 10"; empty if all values of the type are allowed.
  std::string allowed;
  std::string text;  ///< One-line description.
  bool required = false;
};

struct KeySection {
  /// Dotted key, in which N stands for the index of a list element; empty for the whole file.
  std::string key;
  std::string method;  ///< Method that has these keys; empty if all methods have them.
  std::string text;    ///< One-line description.
  std::vector<KeyInfo> keys;
};

/// Returns the sections of a scenario in the order of the file. Each section precedes the sections
/// inside it.
std::vector<KeySection> ScenarioKeys();

/// The sections of a study.
std::vector<KeySection> StudyKeys();

/// The sections of a log map (recording/log_map.h).
std::vector<KeySection> LogMapKeys();

/// The sections of an identification.
std::vector<KeySection> IdentificationKeys();

}  // namespace trackbed
