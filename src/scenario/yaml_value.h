#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>

#include "trackbed/core/classic_locale.h"
#include "trackbed/options/key_visitor.h"

/// Reads single values of YAML files, and describes them for error messages. A YAML value in quotes
/// is always a text, never a number.
namespace trackbed {

/// Returns whether a YAML value is in quotes.
bool IsQuoted(const YAML::Node& node);

/// Reads a value of type T. Returns false if the YAML value is not of type T. A quoted value is
/// text, even if it looks like a number.
template <typename T>
bool Decode(const YAML::Node& node, T& value) {
  const ClassicLocale locale;  // yaml-cpp uses the global locale to parse numbers
  return node.IsScalar() && !IsQuoted(node) && YAML::convert<T>::decode(node, value);
}

/// Describes a YAML node for error messages, for example as "a section", "a list" or "'word'".
std::string DescribeValue(const YAML::Node& node);

/// Describes a value that is not of type T, for error messages. If the value would be of type T
/// without its quotes, the description suggests removing the quotes.
template <typename T>
std::string DescribeWrong(const YAML::Node& node) {
  T value{};
  const bool is_one = IsQuoted(node) && YAML::convert<T>::decode(node, value);
  return DescribeValue(node) + (is_one ? "; write it without quotes" : "");
}

/// Returns the length of a list of numbers as text: "an empty list", "1 number", "3 numbers".
std::string CountNumbers(std::size_t count);

/// Returns an error message if a number is not finite or outside of the range, else "".
std::string NumberProblem(double number, const Range& range);

/// Returns an error message if `name` is not allowed as the name of a folder, else "".
std::string FolderNameProblem(const std::string& name);

/// Reads a finite number within the range. If the node is no finite number within the range,
/// returns an error message and leaves `value` unchanged; else returns "".
std::string ParseNumber(const YAML::Node& node, Range range, double& value);

}  // namespace trackbed
