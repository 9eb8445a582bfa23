#pragma once

#include "tests/audit/record.h"
#include "trackbed/analysis/run.h"
#include "trackbed/drive/car_cache.h"

namespace audit {

/// Runs a scenario and returns the data for the checker. Configurations are recorded at every
/// physics step, regardless of the scenario's state_period. Throws InputError like
/// trackbed::RunScenario.
Record RecordRun(trackbed::Scenario scenario);

/// Only plans a scenario, without driving it; the record has no drives. Reads cars from `cars`.
Record RecordPlan(const trackbed::Scenario& scenario, trackbed::CarCache& cars);

}  // namespace audit
