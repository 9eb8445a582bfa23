#pragma once

#include "tests/audit/record.h"
#include "trackbed/analysis/run.h"

namespace audit {

/// Runs a scenario and keeps what the checker needs. The scenario's configurations are recorded at
/// every physics step, whatever its state_period is. InputError as trackbed::RunMission.
Record RecordRun(trackbed::Scenario scenario);

}  // namespace audit
