#include "src/drive/plan_remedies.h"

#include <fmt/format.h>

#include <algorithm>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/car_lengths.h"

namespace trackbed {
namespace {

/// Limits of the computing time of a remedy (a changed scenario): the numbers of random samples and
/// of searched poses.
constexpr long kRemedySamples = kMaxSamples / 20;
constexpr int kRemedyPoses = 20'000;

/// Returns whether planning failed for lack of space, so that another start or another planner may
/// help.
bool LacksRoom(PlanStatus status) {
  return status == PlanStatus::kNoPath || status == PlanStatus::kTurnTooTight ||
         status == PlanStatus::kCollides || status == PlanStatus::kBudgetUsedUp ||
         status == PlanStatus::kStartBlocked || status == PlanStatus::kUTurn;
}

/// Returns whether the planner finds a path to the goal that the car can drive.
bool Succeeds(const PlanRequest& request, const PlannerOptions& planner) {
  const FeasiblePlan plan = MakePlan(request, planner);
  return plan.ok() && plan->partial.empty();
}

/// Returns the options of the planner hybrid_astar (`plan: {method: hybrid_astar}`) for a car, with
/// a smaller budget of poses. For small cars, the lengths in the options are scaled with the car's
/// length, as in scenarios.
HybridAStarOptions HybridFor(const VehicleParams& vehicle) {
  HybridAStarOptions options;
  const double scale = std::min(1.0, vehicle.length / kFullSizeCar);
  for (double* length : {&options.safe_distance, &options.cell, &options.margin,
                         &options.switch_cost, &options.steering_cost}) {
    *length *= scale;
  }
  options.cell = std::max(options.cell, route::kCellSize.min);
  options.budget = std::min(options.budget, kRemedyPoses);
  return options;
}

/// Returns the first of the following changes that leads to a path: a start at rest, the planner
/// `hybrid_astar`, or both. Returns an empty text if no change leads to a path.
std::string MoreRoom(const PlanRequest& request, const PlanSpec& spec) {
  const HybridAStarOptions options = HybridFor(request.vehicle);
  const bool may_reverse = !spec.avoid && !spec.replan;
  PlanRequest at_rest = request;
  at_rest.start_speed = 0.0;
  at_rest.max_samples = kRemedySamples;
  const bool rolls = request.start_speed > 0.0;
  if (rolls && Succeeds(at_rest, spec.global)) {
    return "there is a path with mission.start.speed: 0";
  }
  if (may_reverse && Succeeds(request, options)) {
    return "there is a path with plan: {method: hybrid_astar}";
  }
  if (may_reverse && rolls && Succeeds(at_rest, options)) {
    return "there is a path with plan: {method: hybrid_astar} and mission.start.speed: 0";
  }
  return "";
}

}  // namespace

std::vector<std::string> PlanRemedies(PlanStatus status, const PlanRequest& request,
                                      const PlanSpec& spec, const std::vector<OrientedBox>& walls) {
  std::vector<std::string> remedies;
  const PlannerEntry& entry = PlannerFor(spec.global);
  if (entry.keeps_clear && LacksRoom(status)) {
    if (std::string remedy = MoreRoom(request, spec); !remedy.empty()) {
      remedies.push_back(std::move(remedy));
    }
  }
  if (status == PlanStatus::kInfeasible && entry.has_headings && !request.headings.empty() &&
      request.obstacles.empty()) {
    PlanRequest free = request;
    free.headings.clear();
    if (Succeeds(free, spec.global)) {
      remedies.emplace_back("there is a path without mission.headings");
    }
  }
  if ((spec.avoid || spec.replan) && request.obstacles.size() != walls.size()) {
    PlanRequest without = request;
    without.obstacles = walls;
    if (MakePlan(without, spec.global).ok()) {
      remedies.push_back(fmt::format(
          "without the obstacles that are known at the start, {} finds a path: to "
          "leave an obstacle to {}, give it known_from: {{time: 0.1}}, or use a planner "
          "that ignores obstacles, such as plan.global: {{method: course}}",
          entry.name, spec.replan ? "plan.replan" : "plan.avoid"));
    }
  }
  return remedies;
}

}  // namespace trackbed
