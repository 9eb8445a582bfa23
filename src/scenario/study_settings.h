#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// Returns whether a setting of the key `later` overwrites an earlier setting of the key `earlier`
/// completely.
bool Replaces(const std::string& later, const std::string& earlier);

/// Returns the key of an override text of the form "key=value".
std::string OverrideKey(const Override& override_text);

/// Returns all settings of a run at a grid point, in the order in which the settings are applied.
std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected);

/// Parses a YAML value as a number; returns none if the value is not a number.
std::optional<double> NumberOf(const std::string& value);

/// Returns settings of all keys whose values differ between the runs of a study; each of these keys
/// has at least one setting.
std::vector<Setting> Varied(const Study& study);

/// Returns the setting of a varied key to `value`; its file position is that of the key in the
/// study file.
Setting SettingOf(const Variation& variation, std::string value);

}  // namespace trackbed
