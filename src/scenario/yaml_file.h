#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

namespace trackbed {

/// Reads the whole file. Throws InputError if it cannot be read.
std::string ReadInput(const std::filesystem::path& file);

/// Parses a text as a YAML value. Throws InputError with line, column and an explanation for
/// invalid text (not UTF-8, control characters), invalid YAML, more than one document, and
/// excessive nesting or repetition.
YAML::Node LoadYamlValue(const std::string& text, const std::string& file);

/// As LoadYamlValue, but the value must be a section. `what` names the content in the message.
YAML::Node LoadYaml(const std::string& text, const std::string& file,
                    const char* what = "a scenario");

/// The node at a dotted key, or its nearest existing ancestor.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key);

}  // namespace trackbed
