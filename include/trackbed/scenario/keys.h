#pragma once

#include <string>
#include <vector>

/// All keys of scenarios, studies and log maps, listed by the code that reads them.
namespace trackbed {

struct KeyInfo {
  std::string name;      ///< within its section
  std::string type;      ///< "number", "list of names", "section", …
  std::string unit;      ///< "m/s"; empty for non-quantities
  std::string fallback;  ///< default value; empty when there is none
  std::string allowed;   ///< "above 0 and at most 10"; empty for all values of the type
  std::string text;      ///< description, one line
  bool required = false;
};

struct KeySection {
  std::string key;     ///< dotted, with N for the elements of a list; empty for the whole file
  std::string method;  ///< the method that has these keys; empty when they do not depend on one
  std::string text;    ///< description, one line
  std::vector<KeyInfo> keys;
};

/// The sections in the order of the file, each before those inside it.
std::vector<KeySection> ScenarioKeys();

/// The sections of a study.
std::vector<KeySection> StudyKeys();

/// The sections of a log map (recording/log_map.h).
std::vector<KeySection> LogMapKeys();

/// The sections of an identification.
std::vector<KeySection> IdentificationKeys();

}  // namespace trackbed
