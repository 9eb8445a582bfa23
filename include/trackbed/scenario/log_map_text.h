#pragma once

#include <string>

#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Formats a log map as YAML. ReadLogMap reads the same log map from this YAML.
std::string LogMapText(LogMap map);

}  // namespace trackbed
