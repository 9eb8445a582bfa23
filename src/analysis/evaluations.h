#pragma once

#include <optional>
#include <vector>

#include "trackbed/analysis/maneuver_metrics.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/planning/common/plan.h"

/// Declares the functions Evaluate, one for each kind of maneuver, which EvaluateManeuver calls.
/// Each function Evaluate sets the members values, passed, missing, begin and end of
/// ManeuverMetrics.
namespace trackbed {

/// Describes a value that is measured in a maneuver. The source file that evaluates a maneuver also
/// lists the metrics of the maneuver.
struct ManeuverMetric {
  const char* name;
  const char* label;
  const char* unit;
  bool headline = false;
  std::optional<StandardLimit> limit = std::nullopt;  ///< limit for passing
};

struct ManeuverInput {
  const RunLog& log;
  const Plan& plan;
  const VehicleParams& vehicle;
};

void Evaluate(const SteadyStateCircleOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const SlowlyIncreasingSteerOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const StepSteerOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const SineWithDwellTestOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const LaneChangeOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const BrakingTestOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);
void Evaluate(const DisturbanceOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics);

std::vector<ManeuverMetric> MethodMetrics(const SteadyStateCircleOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const SlowlyIncreasingSteerOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const StepSteerOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const SineWithDwellTestOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const LaneChangeOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const BrakingTestOptions& options);
std::vector<ManeuverMetric> MethodMetrics(const DisturbanceOptions& options);

}  // namespace trackbed
