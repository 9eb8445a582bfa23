#pragma once

#include <string>

#include "trackbed/recording/log_map.h"

namespace trackbed {

/// Formats a log map as YAML. ReadLogMap reads the same map.
std::string LogMapText(LogMap map);

}  // namespace trackbed
