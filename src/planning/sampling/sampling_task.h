#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Shared by the sampling planners. All random numbers are used in the car's start frame, so a
/// mission that is moved or rotated as a whole gets the same plan, moved or rotated.
namespace trackbed {

/// The mission in the car's start frame.
struct SamplingTask {
  Vec2 lead{0.0, 0.0};      ///< root of the first tree
  std::vector<Vec2> goals;  ///< in order
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;
  GridArea area;  ///< sampled area
  WindScoring wind;
};

/// The keys that define a task.
struct SamplingTaskOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.0;
  double corner_room = 0.0;
  double margin = 0.0;
  double lead_in = 0.0;
  double wind_weight = 0.0;
};

SamplingTask MakeSamplingTask(const SamplingTaskOptions& options, const PlanRequest& request);

/// Checks the initial straight; returns a failed plan with the reason if it is blocked.
Plan CheckLeadIn(const SamplingTask& task);

/// Tangent lengths of corners at the lowest speed, tabulated by heading change.
class CornerTangents {
 public:
  CornerTangents(const VehicleParams& vehicle, double speed);

  /// Never too short: uses the next larger heading change in the table.
  double operator()(double turn) const;

 private:
  static constexpr std::size_t kCount = 200;
  static constexpr double kStep = kPi / kCount;
  std::array<double, kCount> lengths_{};  // the entry for straight on is 0
};

/// Appends a tree's path to `points` without needless corners. The path begins at the last of
/// `points`, which begin with the start.
void AddPruned(const SamplingTask& task, const CornerTangents& tangents, double corner_cost,
               const std::vector<Vec2>& path, bool is_last, std::vector<Vec2>& points);

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points);

/// The failure of a plan whose waypoint, counted from 0, is blocked.
Plan GoalBlocked(const SamplingTask& task, std::size_t waypoint);

/// Length of the initial straight [m]: `lead_in`, but at most half the distance to the first
/// waypoint after the start.
double StraightStart(double lead_in, const PlanRequest& request);

/// Number of initial straights that PlanWithLeadIn tries.
inline constexpr int kLeadIns = 3;

/// Retries a failed plan of a rolling car, which may need more room before its first corner than
/// the trees leave. Tries up to `tries` longer initial straights. The first and longest one lets
/// the car stop; if an obstacle blocks it, a half or a quarter of it may fit. These two grow only
/// one tree each, because many refused missions have no plan at all.
template <typename Options, typename PlanTrees>
Plan PlanWithLeadIn(const Options& options, const PlanRequest& request, const PlanTrees& plan_trees,
                    int tries) {
  PlanRequest left = request;
  Plan plan = plan_trees(options, left);
  long samples = plan.diagnostics.samples;
  const bool too_near =
      plan.status == PlanStatus::kTurnTooTight || plan.status == PlanStatus::kInfeasible;
  if (!too_near || options.corners == Corners::kRefuse || request.start_speed == 0.0) {
    return plan;
  }
  double more = 0.5 * request.start_speed * request.start_speed / request.speed.deceleration +
                request.vehicle.min_turning_radius();
  // The same initial straight would only repeat the same trees.
  std::vector<double> tried{StraightStart(options.lead_in, request)};
  for (int i = 0; i < tries; ++i, more *= 0.5) {
    Options longer = options;
    longer.lead_in += more;
    longer.trees = i == 0 ? options.trees : 1;
    const double straight = StraightStart(longer.lead_in, request);
    if (samples >= request.max_samples ||
        std::find(tried.begin(), tried.end(), straight) != tried.end()) {
      continue;
    }
    tried.push_back(straight);
    left.max_samples = request.max_samples - samples;
    Plan again = plan_trees(longer, left);
    samples += again.diagnostics.samples;
    if (again.ok()) {
      plan = std::move(again);
      break;
    }
  }
  plan.diagnostics.samples = samples;
  return plan;
}

}  // namespace trackbed
