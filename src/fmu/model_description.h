#pragma once

#include <string>
#include <vector>

#include "src/fmu/variables.h"
#include "trackbed/fmu/export.h"

namespace trackbed::fmu {

/// Name of the shared library in an FMU, without its ending.
inline constexpr const char* kModelIdentifier = "trackbed";

/// The contents of modelDescription.xml besides the variables.
struct Description {
  std::string name;
  std::string token;            ///< Text that identifies the resources of the FMU.
  double control_period = 0.0;  ///< Control period [s].
};

/// Returns modelDescription.xml, as FMI 2.0.4 or 3.0.2 defines it.
std::string ModelDescription(const Description& description, const std::vector<Variable>& variables,
                             FmiVersion version);

}  // namespace trackbed::fmu
