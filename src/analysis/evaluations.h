#pragma once

#include "trackbed/analysis/manoeuvre.h"
#include "trackbed/planning/common/plan.h"

/// The evaluations behind EvaluateManoeuvre: each fills in values, passed, missing, begin and end.
namespace trackbed {

struct ManoeuvreInput {
  const RunLog& log;
  const Plan& plan;
  const VehicleParams& vehicle;
};

void Evaluate(const SteadyStateCircleOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const SlowlyIncreasingSteerOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const StepSteerOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const SineWithDwellTestOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const LaneChangeOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const BrakingTestOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);
void Evaluate(const DisturbanceOptions& options, const ManoeuvreInput& input,
              ManoeuvreMetrics& metrics);

}  // namespace trackbed
