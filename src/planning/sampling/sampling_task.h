#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/sampling/smoothing.h"

/// What the planners with random trees have in common. Everything random happens in the frame of
/// the car at its start, so that a mission that is moved or turned as a whole gets the same plan,
/// moved or turned.
namespace trackbed {

/// The mission in the frame of the car at its start.
struct SamplingTask {
  Vec2 lead{0.0, 0.0};      ///< where the trees begin
  std::vector<Vec2> goals;  ///< one after the other
  std::vector<OrientedBox> obstacles;
  double inflation = 0.0;
  GridArea area;  ///< that is sampled
  WindScoring wind;
};

/// The keys that make a task of a mission.
struct SamplingTaskOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.0;
  double corner_room = 0.0;
  double margin = 0.0;
  double lead_in = 0.0;
  double wind_weight = 0.0;
};

SamplingTask MakeSamplingTask(const SamplingTaskOptions& options, const PlanRequest& request);

/// Why the first piece of straight path is blocked, if it is: otherwise a plan that is ok.
Plan CheckLeadIn(const SamplingTask& task);

/// Tangent lengths of corners at the lowest speed, by their change of heading.
class CornerTangents {
 public:
  CornerTangents(const VehicleParams& vehicle, double speed);

  /// Never too short: of the next change of heading in the table.
  double operator()(double turn) const;

 private:
  static constexpr std::size_t kCount = 200;
  static constexpr double kStep = kPi / kCount;
  std::array<double, kCount> lengths_{};  // straight on needs none
};

/// Goes on along a tree's path with no more corners than it needs. The path begins at the last of
/// `points`, which begin with the start.
void AddPruned(const SamplingTask& task, const CornerTangents& tangents, double corner_cost,
               const std::vector<Vec2>& path, bool is_last, std::vector<Vec2>& points);

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points);

/// Why a waypoint, counted from 0, is blocked.
Plan GoalBlocked(const SamplingTask& task, std::size_t waypoint);

/// Length of the straight start [m]: `lead_in`, but at most half the distance to the first waypoint
/// after the start.
double StraightStart(double lead_in, const PlanRequest& request);

/// Straight starts that PlanWithLeadIn tries.
inline constexpr int kLeadIns = 3;

/// Plans again for a rolling car, which may need more room before its first corner than the trees
/// leave: with longer straight starts, up to `tries` of them. The longest lets the car come to
/// rest; where something is in its way, a half or a quarter of it may do, for which one tree is
/// grown each: many a refused mission has no plan at all.
template <typename Options, typename PlanTrees>
Plan PlanWithLeadIn(const Options& options, const PlanRequest& request, const PlanTrees& plan_trees,
                    int tries) {
  Plan plan = plan_trees(options, request);
  const bool too_near =
      plan.status == PlanStatus::kTurnTooTight || plan.status == PlanStatus::kInfeasible;
  if (!too_near || options.corners == Corners::kRefuse || request.start_speed == 0.0) {
    return plan;
  }
  double more = 0.5 * request.start_speed * request.start_speed / request.speed.deceleration +
                request.vehicle.min_turning_radius();
  // The same straight start would give the same trees again.
  std::vector<double> tried{StraightStart(options.lead_in, request)};
  for (int i = 0; i < tries; ++i, more *= 0.5) {
    Options longer = options;
    longer.lead_in += more;
    longer.trees = i == 0 ? options.trees : 1;
    const double straight = StraightStart(longer.lead_in, request);
    if (std::find(tried.begin(), tried.end(), straight) != tried.end()) {
      continue;
    }
    tried.push_back(straight);
    Plan again = plan_trees(longer, request);
    if (again.ok()) {
      return again;
    }
  }
  return plan;
}

}  // namespace trackbed
