#pragma once

#include <string>
#include <vector>

#include "trackbed/sim/plant.h"

namespace trackbed {

/// Returns the names of all registered plants.
inline std::vector<std::string> PlantNames() {
  std::vector<std::string> names;
  for (const PlantEntry& entry : Plants()) {
    names.emplace_back(entry.name);
  }
  return names;
}

}  // namespace trackbed
