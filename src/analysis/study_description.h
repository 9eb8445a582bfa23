#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Returns the keys of a study's parameters, in the order of the columns of the study's table.
std::vector<std::string> ParameterKeys(const Study& study);

/// Returns the column names of a study's table.
std::vector<std::string> TableColumns(const Study& study);

/// Converts a YAML value to JSON. Numbers, booleans and null keep their type; other values become
/// JSON strings.
nlohmann::ordered_json SettingsJson(const std::string& value);
nlohmann::ordered_json SettingsJson(const std::vector<Setting>& settings);

/// Describes all inputs that determine the result rows of a study, except the contents of input
/// files. Two studies with equal descriptions and equal input files have equal result rows.
nlohmann::ordered_json DescribeStudy(const Study& study);

}  // namespace trackbed
