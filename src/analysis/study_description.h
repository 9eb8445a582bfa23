#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// The keys of the parameters in the order of their columns.
std::vector<std::string> ParameterKeys(const Study& study);

/// The columns of the table of a study.
std::vector<std::string> TableColumns(const Study& study);

/// A value of YAML as one of JSON: numbers and the like as such, all else as text.
nlohmann::ordered_json SettingsJson(const std::string& value);
nlohmann::ordered_json SettingsJson(const std::vector<Setting>& settings);

/// All that the rows of a study depend on, but for the contents of its files: two studies with
/// equal descriptions have the same rows.
nlohmann::ordered_json DescribeStudy(const Study& study);

}  // namespace trackbed
