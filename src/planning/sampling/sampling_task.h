#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/geometry/box_index.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/lead_in.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/sampling/smoothing.h"

/// Functions that the sampling planners share. The planners draw their random samples in the car's
/// start frame. If a whole mission is moved or rotated, the samples and the plan are moved or
/// rotated in the same way.
namespace trackbed {

/// The mission in the car's start frame.
struct SamplingTask {
  /// First points of the path [m], from the start to the root of the first tree. The first leg is
  /// the initial straight.
  std::vector<Vec2> departure{};
  std::vector<Vec2> goals;  ///< Goals of the trees, in the order of the mission.
  std::vector<OrientedBox> obstacles;
  /// Distance that the lines of the search keep from obstacles. From an obstacle that is nearer to
  /// a goal or to the end of the departure, the lines keep a smaller distance.
  Inflation inflation = 0.0;
  /// Distance that the departure keeps from obstacles. From an obstacle that is nearer to the
  /// start, the departure keeps a smaller distance.
  Inflation lead_inflation = 0.0;
  GridArea area;  ///< Area from which the planners sample.
  WindScoring wind;
};

/// Options that define a sampling task.
struct SamplingTaskOptions {
  Corners corners = Corners::kRound;
  double safe_distance = 0.0;
  double corner_room = 0.0;
  double margin = 0.0;
  double lead_in = 0.0;
  double wind_weight = 0.0;
  /// First points of the path in the world frame [m]; empty: an initial straight (`lead_in`).
  std::vector<Vec2> departure{};
};

SamplingTask MakeSamplingTask(const SamplingTaskOptions& options, const PlanRequest& request);

/// Returns the task of a planner with the given options, whose path begins with `departure`.
template <typename Options>
SamplingTask TaskOf(const Options& options, const PlanRequest& request,
                    const std::vector<Vec2>& departure, double wind_weight) {
  return MakeSamplingTask({.corners = options.corners,
                           .safe_distance = options.safe_distance,
                           .corner_room = options.corner_room,
                           .margin = options.margin,
                           .lead_in = options.lead_in,
                           .wind_weight = wind_weight,
                           .departure = departure},
                          request);
}

/// Visits the first keys of a planner: corners, area, initial straight and lowest speed.
template <typename Options>
void VisitTaskKeys(KeyVisitor& keys, Options& options) {
  route::VisitCorners(keys, options.corners, options.safe_distance, options.corner_room);
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"lead_in", "m", "straight distance from the start before the trees; 0: none"},
             options.lead_in, Need::kOptional, kNonNegative);
  keys.Field(route::kCornerSpeed, options.min_speed, Need::kOptional, kPositive);
}

inline constexpr Key kCornerCost{
    "corner_cost", "m", "cost of a corner, as path length: favors fewer corners and longer legs"};

/// Checks whether the car is clear of obstacles at its start, and whether the first points of the
/// path are free. The first points are free (of collisions) if all lines between
/// two successive points keep the distance `task.lead_inflation` from obstacles. An initial
/// straight is also free if the car's footprint keeps `safe_distance`. If a check fails, returns a
/// failed plan with the reason.
Plan CheckLeadIn(const SamplingTask& task, const PlanRequest& request, double safe_distance);

/// Tangent lengths of corners at the lowest speed, tabulated by heading change.
class CornerTangents {
 public:
  CornerTangents(const VehicleParams& vehicle, double speed);

  /// Returns the tangent length [m] of the smallest tabulated heading change that is at least
  /// `turn`, so the length is never too short.
  double operator()(double turn) const;

 private:
  static constexpr std::size_t kCount = 200;
  static constexpr double kStep = kPi / kCount;
  std::array<double, kCount> lengths_{};  // the entry for a heading change of 0 is 0
};

/// Appends a tree's path to `points`, without needless corners. The first of `points` must be the
/// start of the mission, and the last must be the start of the tree's path.
void AddPruned(const SamplingTask& task, const CornerTangents& tangents, double corner_cost,
               const std::vector<Vec2>& path, bool is_last, std::vector<Vec2>& points);

std::vector<Vec2> InWorld(const Pose2& frame, std::vector<Vec2> points);

/// Returns the length of the initial straight [m]: `lead_in`, but at most half the distance to the
/// first waypoint after the start.
double StraightStart(double lead_in, const PlanRequest& request);

/// Returns DeparturePolylines if the first waypoint is behind or beside the car, or so near that
/// the car passes it before it is slow enough to turn; otherwise nothing.
std::vector<std::vector<Vec2>> DeparturesToNearWaypoint(const PlanRequest& request);

/// Number of initial straights that PlanWithLeadIn tries.
inline constexpr int kLeadIns = 3;

/// The plan of one call of `plan_trees`.
struct TreesPlan {
  Plan plan;
  /// The best plan before MakeFeasible rejected it; nullopt if no plan was rejected. Explains the
  /// rejection.
  std::optional<Plan> rejected{};
};

/// Returns the plan along `points` in the car's start frame, with rounded corners. If the plan is
/// not feasible, returns the reason, and the plan as `rejected`.
template <typename Options>
TreesPlan PlanAlong(const Options& options, const PlanRequest& request,
                    const std::vector<Vec2>& points) {
  Plan plan = route::AlongPolyline({}, request, InWorld(request.start, points), options.corners,
                                   options.safe_distance, options.min_speed);
  if (Plan tested = MakeFeasible(plan, request); !tested.ok()) {
    return {std::move(tested), plan.ok() ? std::optional(std::move(plan)) : std::nullopt};
  }
  return {std::move(plan)};
}

/// Returns whether another start of the path may lead to a plan.
inline bool IsTooNear(const Plan& plan) {
  return plan.status == PlanStatus::kTurnTooTight || plan.status == PlanStatus::kInfeasible ||
         plan.status == PlanStatus::kUTurn || plan.status == PlanStatus::kWaypointMissed;
}

/// Plans with `plan_trees`. If the plan fails because its first corner is too near, PlanWithLeadIn
/// retries with up to `tries` longer initial straights. The first retry lengthens the initial
/// straight by the car's stopping distance plus its smallest turning radius. If an obstacle blocks
/// this longest initial straight, the next retries add only a half or a quarter of the additional
/// length. For a car at rest, the next retry uses half of the initial straight, because an obstacle
/// ahead may block the whole straight. The last retries begin with DeparturesToNearWaypoint, unless
/// the options have no initial straight, or allow only one retry. Later retries grow only one tree
/// each. Many of the retried missions have no plan at all, so more trees would waste computing
/// time. A rejection of the first plan includes an explanation (Refusal::kExplained).
template <typename Options, typename PlanTrees>
Plan PlanWithLeadIn(const Options& options, const PlanRequest& request, const PlanTrees& plan_trees,
                    int tries) {
  PlanRequest left = request;
  TreesPlan first = plan_trees(options, left, std::vector<Vec2>{});
  Plan plan = std::move(first.plan);
  const bool is_lead_in_blocked = plan.status == PlanStatus::kStartBlocked &&
                                  route::CheckStart(request, options.safe_distance).ok();
  if (!(IsTooNear(plan) || is_lead_in_blocked) || options.corners == Corners::kRefuse) {
    return plan;
  }
  long samples = plan.diagnostics.samples;
  const auto retry = [&](const Options& changed, const std::vector<Vec2>& departure) {
    left.max_samples = request.max_samples - samples;
    Plan again = plan_trees(changed, left, departure).plan;
    samples += again.diagnostics.samples;
    if (again.ok()) {
      plan = std::move(again);
    }
    return plan.ok();
  };
  double more = 0.5 * request.start_speed * request.start_speed / request.speed.deceleration +
                request.vehicle.min_turning_radius();
  // Skip lengths that were tried before, because the same initial straight would give the same
  // trees.
  std::vector<double> tried{StraightStart(options.lead_in, request)};
  const auto retry_straight = [&](double lead_in, int trees) {
    Options changed = options;
    changed.lead_in = lead_in;
    changed.trees = trees;
    const double straight = StraightStart(lead_in, request);
    if (samples < request.max_samples &&
        std::find(tried.begin(), tried.end(), straight) == tried.end()) {
      tried.push_back(straight);
      retry(changed, {});
    }
  };
  const bool lengthens =
      (request.start_speed > 0.0 || options.lead_in > 0.0) && !is_lead_in_blocked;
  for (int i = 0; i < tries && !plan.ok() && lengthens; ++i, more *= 0.5) {
    retry_straight(options.lead_in + more, i == 0 ? options.trees : 1);
  }
  if (!plan.ok() && request.start_speed <= 0.0 && tries > 1) {
    retry_straight(0.5 * options.lead_in, 1);
  }
  if (!plan.ok() && options.lead_in > 0.0 && tries >= kLeadIns) {
    Options once = options;
    once.trees = 1;
    for (const std::vector<Vec2>& departure : DeparturesToNearWaypoint(request)) {
      if (samples >= request.max_samples || retry(once, departure)) {
        break;
      }
    }
  }
  if (plan.status == PlanStatus::kInfeasible && first.rejected) {
    Plan explained = MakeFeasible(std::move(*first.rejected), request, Refusal::kExplained);
    plan.reason = explained.reason;
  }
  plan.diagnostics.samples = samples;
  return plan;
}

}  // namespace trackbed
