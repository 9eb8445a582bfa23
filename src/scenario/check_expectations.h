#pragma once

#include "src/scenario/diagnostics.h"

namespace trackbed {

/// Checks the expectations, and adds the problems found to `c`.
void CheckExpectations(Diagnostics& c);

}  // namespace trackbed
