#pragma once

#include <vector>

#include "trackbed/analysis/manoeuvre.h"
#include "trackbed/planning/common/plan.h"

/// The evaluations behind EvaluateManoeuvre: each fills in values, passed, missing, begin and end.
namespace trackbed {

/// One of the values of a manoeuvre. Each manoeuvre lists its own beside its evaluation.
struct ManoeuvreMetric {
  const char* name;
  const char* label;
  const char* unit;
  bool headline = false;
};

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

std::vector<ManoeuvreMetric> MetricsOf(const SteadyStateCircleOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const SlowlyIncreasingSteerOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const StepSteerOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const SineWithDwellTestOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const LaneChangeOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const BrakingTestOptions& options);
std::vector<ManoeuvreMetric> MetricsOf(const DisturbanceOptions& options);

}  // namespace trackbed
