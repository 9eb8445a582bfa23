#pragma once

#include <vector>

#include "trackbed/analysis/run.h"

/// Functions that evaluate a run; SimulateRun calls them for the logs that it simulates. Call
/// PlanRun, AddLog and JudgeRun for a log from another source, such as a SteppedLoop:
///
///     RunResult result = PlanRun(scenario, car);
///     AddLog(result, car, log);
///     JudgeRun(result, car);
namespace trackbed {

/// Appends the log of a plant to the result, with its metrics. The result must have a plan, and
/// `log` must have a plant and at least one row. `windows` are the prediction errors against a
/// recorded drive (MeasureRecordWindows); empty if they were not measured.
void AddLog(RunResult& result, const CarModel& car, RunLog log,
            std::vector<WindowErrors> windows = {});

/// Compares every pair of plants, judges the run by the scenario's expectations, and collects the
/// notes. Call JudgeRun once, after the last call of AddLog.
void JudgeRun(RunResult& result, const CarModel& car);

}  // namespace trackbed
