#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

namespace trackbed {

/// Reads the whole content of a file. If the file cannot be read, ReadInput throws InputError.
std::string ReadInput(const std::filesystem::path& file);

/// Parses a text as a YAML value. If the text is invalid, LoadYamlValue throws InputError with
/// line, column and an explanation. A text is invalid if it is not UTF-8 or not YAML, if it
/// contains control characters or several documents, or if it is nested or repeated excessively.
YAML::Node LoadYamlValue(const std::string& text, const std::string& file);

/// Parses a text as a YAML section, with the same errors as LoadYamlValue. LoadYaml also throws
/// InputError if the YAML value is not a section. The argument `what` names the content of the file
/// in error messages, such as "a scenario".
YAML::Node LoadYaml(const std::string& text, const std::string& file,
                    const char* what = "a scenario");

/// Returns the node at a dotted key; if the node does not exist, returns its nearest existing
/// ancestor.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key);

}  // namespace trackbed
