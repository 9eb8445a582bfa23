#include "src/analysis/clearance_remedy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "trackbed/analysis/path_properties.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

std::optional<double> PlannedClearance(const RunResult& result, const VehicleParams& vehicle) {
  for (const PathProperty& property : PathProperties()) {
    if (std::string_view(property.name) == "clearance_min_m") {
      return property.measure({*result.plan, result.scenario.world, vehicle});
    }
  }
  return std::nullopt;
}

/// Returns the key and the value [m] of the distance that the plan keeps from obstacles; nullopt if
/// the planner has no such key. The local planner `listing` keeps no distance.
std::optional<std::pair<std::string, double>> KeptDistance(const PlanSpec& plan) {
  if (plan.replan) {
    return std::pair("plan.replan.safe_distance", plan.replan->settings.safe_distance);
  }
  if (plan.avoid) {
    const auto* curves = std::get_if<BezierAvoidanceOptions>(&*plan.avoid);
    return curves != nullptr
               ? std::optional(std::pair("plan.avoid.safe_distance", curves->safe_distance))
               : std::nullopt;
  }
  const std::optional<double> own = PlannerSafeDistance(plan.global);
  return own ? std::optional(std::pair("plan.safe_distance", *own)) : std::nullopt;
}

/// Returns the distance [m] that the driven plan keeps from obstacles. A local planner changes the
/// plan of the start, and keeps `kept` from obstacles.
double PlannedDistance(const RunResult& result, const VehicleParams& vehicle, double kept) {
  const PlanSpec& plan = *result.scenario.plan;
  return plan.avoid || plan.replan ? kept : PlannedClearance(result, vehicle).value_or(kept);
}

/// Returns the distance [m] that detours keep from obstacles; nullopt if there are no detours.
std::optional<double> DistanceOfDetours(const PlanSpec& plan) {
  return plan.replan && plan.replan->detour ? PlannerSafeDistance(*plan.replan->detour)
                                            : std::nullopt;
}

}  // namespace

void ProposeSafeDistance(RunResult& result, const VehicleParams& vehicle) {
  const auto kept = result.scenario.plan ? KeptDistance(*result.scenario.plan) : std::nullopt;
  for (const Check& check : result.verdict.checks) {
    const double* bound = std::get_if<double>(&check.bound);
    const double* driven = std::get_if<double>(&check.value);
    if (!kept || check.met || check.metric != "clearance_min" || !bound || !driven) {
      continue;
    }
    const double planned = PlannedDistance(result, vehicle, kept->second);
    // The remedy is rounded up to centimeters.
    const double needed = std::ceil(100.0 * (*bound + std::max(planned - *driven, 0.0))) / 100.0;
    std::string keys = fmt::format("{}: {:.4g} (now {:.4g})", kept->first, needed, kept->second);
    if (const auto detour = DistanceOfDetours(*result.scenario.plan); detour && *detour < needed) {
      keys += fmt::format(" and plan.replan.detour.safe_distance: {:.4g} (now {:.4g})", needed,
                          *detour);
    }
    result.verdict.notes.push_back(fmt::format(
        "{}: the plan keeps at least {:.3g} m from obstacles, the car came within {:.3g} m; for "
        "{:.4g} m, set {}, or let the car follow its plan more closely",
        check.plant, planned, *driven, *bound, keys));
  }
}

}  // namespace trackbed
