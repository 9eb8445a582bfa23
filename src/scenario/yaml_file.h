#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

namespace trackbed {

/// The whole file. InputError when it cannot be read.
std::string ReadInput(const std::filesystem::path& file);

/// The value that a YAML text is. InputError with line, column and plain words for what is no text
/// (bytes that are not UTF-8, control characters), no YAML, more than one document, or nested or
/// repeated without end.
YAML::Node LoadYamlValue(const std::string& text, const std::string& file);

/// The same, and it is a section; `what` is what the file holds.
YAML::Node LoadYaml(const std::string& text, const std::string& file,
                    const char* what = "a scenario");

/// The node that a dotted key names, or the nearest one above it that is there.
YAML::Node NodeAt(const YAML::Node& root, const std::string& key);

}  // namespace trackbed
