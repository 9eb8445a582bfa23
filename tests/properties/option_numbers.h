#pragma once

#include <functional>
#include <string>

#include "trackbed/options/key_visitor.h"

namespace properties {

/// Calls the function `call` for every number among the keys that `visit` declares. The function
/// may read or set the number.
void ForEachNumber(
    const trackbed::KeyVisitor::Inside& visit,
    const std::function<void(const std::string& key, double& value, trackbed::Range range)>& call);

}  // namespace properties
