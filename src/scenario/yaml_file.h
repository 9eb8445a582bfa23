#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

namespace trackbed {

/// Reads the whole content of a file. ReadInput throws InputError if the file cannot be read.
std::string ReadInput(const std::filesystem::path& file);

/// Parses a text as a YAML value. LoadYamlValue throws InputError with line, column and an
/// explanation. Text is invalid if it is not UTF-8 or not YAML, has control characters or several
/// documents, or is nested or repeated excessively.
YAML::Node LoadYamlValue(const std::string& text, const std::string& file);

/// Same as LoadYamlValue, but the value must be a section. Messages call the content of the file
/// `what`.
YAML::Node LoadYaml(const std::string& text, const std::string& file,
                    const char* what = "a scenario");

/// The node at a dotted key, or the nearest existing ancestor of that node.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key);

}  // namespace trackbed
