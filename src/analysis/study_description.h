#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Keys of the parameters, in the order of their columns.
std::vector<std::string> ParameterKeys(const Study& study);

/// Column names of a study's table.
std::vector<std::string> TableColumns(const Study& study);

/// Converts a YAML value to JSON: numbers, booleans and the like keep their type, anything else
/// becomes text.
nlohmann::ordered_json SettingsJson(const std::string& value);
nlohmann::ordered_json SettingsJson(const std::vector<Setting>& settings);

/// Everything that the rows of a study depend on, except the contents of its files. Two studies
/// with equal descriptions have equal rows.
nlohmann::ordered_json DescribeStudy(const Study& study);

}  // namespace trackbed
