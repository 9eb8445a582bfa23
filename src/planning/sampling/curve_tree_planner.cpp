#include "src/planning/sampling/curve_tree_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "src/planning/curves/faster_route.h"
#include "src/planning/sampling/curve_tree.h"
#include "src/planning/sampling/sampling_task.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

ContinuousRoute RouteFor(const RrtStarPlannerOptions& options, const PlanRequest& request) {
  return {.motion = CurveMotion::kForwards,
          .objective = CurveObjective::kTime,
          .max_lateral_acceleration = options.max_lateral_acceleration,
          .max_steering_rate_fraction = options.max_steering_rate_fraction,
          .radius = route::RadiusFor(request.vehicle, {}),
          .safe_distance = options.safe_distance,
          .min_speed = options.min_speed};
}

/// Returns every third of the speeds of a route and the lowest speed, so that an edge takes about a
/// third of the time to find.
/// A route through the nodes of a tree tries all speeds, so it finds the edges of the tree, too.
std::vector<double> SpeedsOfEdges(const LegFinder& finder) {
  const std::vector<double> all = finder.Speeds();
  std::vector<double> speeds;
  for (std::size_t i = 0; i < all.size(); i += 3) {
    speeds.push_back(all[i]);
  }
  if (speeds.back() > all.back()) {
    speeds.push_back(all.back());
  }
  return speeds;
}

/// Returns the box of the samples. A tree of curves has no straight start.
GridArea SampledArea(RrtStarPlannerOptions options, const PlanRequest& request) {
  options.lead_in = 0.0;
  return TaskOf(options, request, {}, 0.0).area;
}

/// Returns the request to drive through the given stops.
PlanRequest Through(const std::vector<Pose2>& stops, const PlanRequest& request) {
  PlanRequest own = request;
  own.waypoints = {request.waypoints.front()};
  own.headings = {request.start.yaw};
  for (const Pose2& stop : stops) {
    own.waypoints.push_back(stop.position());
    own.headings.push_back(stop.yaw);
  }
  return own;
}

/// Number of samples of PlanRequest::max_samples for each sampled pose: a pose in a tree of curves
/// takes about 5 ms, and a point in a tree of lines 12 us.
constexpr long kSamplesOfPose = 400;

class CurveTreePlanner {
 public:
  CurveTreePlanner(const RrtStarPlannerOptions& options, const PlanRequest& request)
      : options_(options),
        request_(request),
        route_(RouteFor(options, request)),
        stops_(PlannedStops(request)),
        finder_(route_, request),
        speeds_(SpeedsOfEdges(finder_)),
        area_(SampledArea(options, request)) {}

  Plan Make() {
    Plan plan;
    for (int i = 0; i < options_.trees && (i == 0 || samples_ < request_.max_samples); ++i) {
      plan = PlanOfTree(request_.seed + (static_cast<std::uint64_t>(i) << 32U));
      findings_.trees.push_back({plan.status, plan.reason});
      if (plan.ok() || samples_ == 0) {
        break;  // Without samples, all trees are equal.
      }
    }
    plan.diagnostics.planner = std::move(findings_);
    plan.diagnostics.samples = samples_;
    return plan;
  }

 private:
  [[nodiscard]] LegEnds EndsOf(std::size_t leg) const {
    const bool rolls = leg == 0 && request_.start_speed > 0.0;
    const double bend =
        rolls ? CurvatureForSteering(request_.vehicle, request_.start_steering) : 0.0;
    return {.from = {stops_[leg], bend},
            .to = {stops_[leg + 1]},
            .is_first = leg == 0,
            .is_last = leg + 2 == stops_.size()};
  }

  /// Returns the cost of the cheapest leg if there were no obstacles.
  [[nodiscard]] double CostWithoutObstacles(const LegEnds& ends) const {
    PlanRequest free = request_;
    free.obstacles.clear();
    return LegFinder(route_, free).Cheapest(ends, speeds_, kNoCurve).cost;
  }

  CurveTreeResult GrowLeg(std::size_t leg, std::uint64_t seed) {
    CurveTreeProblem problem{
        .ends = EndsOf(leg),
        .frame = request_.start,
        .low = area_.low,
        .high = area_.high,
        .speeds = speeds_,
        .fastest = std::max({request_.speed.speed, request_.start_speed, options_.min_speed}),
        .step = options_.expand_distance.value_or(0.2 * (area_.high - area_.low).norm())};
    CurveTreeResult found = GrowCurveTree(finder_, problem, seed);
    if (!found.ok() || found.cost > CostWithoutObstacles(problem.ends)) {
      problem.iterations = static_cast<int>(std::min<long>(
          options_.iterations, std::max(request_.max_samples - samples_, 0L) / kSamplesOfPose));
      found = GrowCurveTree(finder_, problem, seed);
    }
    samples_ += kSamplesOfPose * found.iterations;
    return found;
  }

  Plan PlanOfTree(std::uint64_t seed) {
    findings_.legs.clear();
    std::vector<Pose2> stops;
    std::vector<TreeNode> tree;
    for (std::size_t leg = 0; leg + 1 < stops_.size(); ++leg) {
      const CurveTreeResult found = GrowLeg(leg, seed + leg);
      RrtStarLeg own{.status = found.ok() ? RrtStarStatus::kFound : RrtStarStatus::kNotReached,
                     .iterations = found.iterations,
                     .nodes = found.nodes.size(),
                     .cost = found.ok() ? std::optional(found.length) : std::nullopt};
      for (const Pose2& pose : found.path) {
        own.path.push_back(pose.position());
      }
      findings_.legs.push_back(std::move(own));
      if (!found.ok()) {
        return NotReached(leg + 1, found.iterations);
      }
      const std::size_t first = tree.size();
      for (const TreeNode& node : found.nodes) {
        tree.push_back({node.position, first + node.parent, node.cost});
      }
      stops.insert(stops.end(), found.path.begin() + 1, found.path.end());
    }
    const PlanRequest through = Through(stops, request_);
    LegCosts known;
    FasterLegs legs;
    Plan plan = FasterRoute(route_, through, PlanContinuousRoute(route_, through, known), legs);
    if (Plan tested = MakeFeasible(plan, request_); !tested.ok()) {
      return tested;
    }
    plan.tree = std::move(tree);
    return plan;
  }

  [[nodiscard]] Plan NotReached(std::size_t waypoint, int samples) const {
    return route::Refused(
        PlanStatus::kBudgetUsedUp,
        fmt::format("waypoint {} not reached by curves through {} samples{}; hybrid_astar searches "
                    "systematically, and can reverse",
                    waypoint, samples,
                    samples < options_.iterations ? ", the last of those allowed" : ""));
  }

  const RrtStarPlannerOptions& options_;
  const PlanRequest& request_;
  ContinuousRoute route_;
  std::vector<Pose2> stops_;
  LegFinder finder_;
  std::vector<double> speeds_;
  GridArea area_;
  RrtStarPlanDiagnostics findings_;
  long samples_ = 0;
};

}  // namespace

Plan PlanCurveTrees(const RrtStarPlannerOptions& options, const PlanRequest& request) {
  if (Plan refused = route::CheckStops(PlannedStops(request), request, options.safe_distance);
      !refused.ok()) {
    return refused;
  }
  return CurveTreePlanner(options, request).Make();
}

}  // namespace trackbed
