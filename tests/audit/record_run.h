#pragma once

#include "tests/audit/record.h"
#include "trackbed/analysis/run.h"

namespace audit {

/// Runs a scenario and returns the data for the checker. Configurations are recorded at every
/// physics step, regardless of the scenario's state_period. Throws InputError like
/// trackbed::RunScenario.
Record RecordRun(trackbed::Scenario scenario);

}  // namespace audit
