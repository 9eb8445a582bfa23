#pragma once

#include <functional>
#include <string>

#include "trackbed/options/key_visitor.h"

namespace properties {

/// Calls a function for every number among the keys that `visit` declares, to read or set it.
void ForEachNumber(
    const trackbed::KeyVisitor::Inside& visit,
    const std::function<void(const std::string& key, double& value, trackbed::Range range)>& call);

}  // namespace properties
