#include "trackbed/planning/grid/hybrid_astar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "src/planning/curves/clothoid_keys.h"
#include "src/planning/grid/pose_search.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/route.h"

// Runs hybrid A* at the requested resolution and, if this finds no path, at a fixed series of
// resolutions from coarse to fine. Coarse bins lose narrow maneuvers; fine bins use up the budget
// in wide areas. The series of resolutions depends on the turning radius alone, so its paths do not
// depend on the options `cell` and `headings`. At each resolution of the series, one search from
// the start and one search from the goal advance in turn. If one of the two searches has expanded
// all its poses, the next resolution follows. The search from the goal detects a tight gap around
// the goal within few poses, while a search from the start would expand the whole area.

namespace trackbed {
namespace {

/// Numbers of heading bins at the coarsest resolution of the series. An arc of 15 degrees is about
/// a quarter of the turning radius long.
constexpr int kCoarsestHeadings = 24;
/// Number of resolutions of the series; each one halves the bins and the steps. The shortest steps
/// are 1.6 % of the turning radius long: for a car, four times the smallest step of
/// CollisionChecker.
constexpr int kResolutions = 5;
/// Maximum number of cells of the grid for the series. Computing the distances on this grid takes
/// as long as expanding about 2000 poses.
constexpr double kMaxSeriesCells = 2.5e5;
/// Number of poses expanded from the start for each pose expanded from the goal, at the requested
/// resolution. The search from the goal only detects that the goal is in a tight gap.
constexpr int kPosesPerGoalPose = 16;

class Searches {
 public:
  Searches(const VehicleParams& vehicle, const HybridAStarProblem& problem,
           const HybridAStarOptions& options)
      : vehicle_(vehicle),
        problem_(problem),
        options_(options),
        radius_(options.radius.value_or(1.1 * vehicle.min_turning_radius())),
        clear_(vehicle, problem.obstacles, options.safe_distance, problem.start),
        area_(AreaAround(problem.start, {problem.start.position(), problem.goal.position()},
                         problem.obstacles, options.margin)) {}

  HybridAStarResult Run() {
    if (CellsIn(area_, options_.cell) > kMaxCells) {
      return Fail(PlanStatus::kBudgetUsedUp,
                  fmt::format("more than {:.3g} cells of {:.3g} m", kMaxCells, options_.cell));
    }
    const std::shared_ptr<const OccupancyGrid> grid = MakeGrid(options_.cell);
    result_.cells = static_cast<int>(grid->size());
    if (!clear_.IsFree(problem_.start)) {
      return Fail(PlanStatus::kStartBlocked, "the start is blocked: " + Nearest(problem_.start));
    }
    if (!clear_.IsFree(problem_.goal)) {
      return Fail(PlanStatus::kGoalBlocked, "the goal is blocked: " + Nearest(problem_.goal));
    }
    const auto to_goal = DistanceTo(grid, problem_.goal);
    if (!Connects(*to_goal)) {
      return Enclosed();
    }
    const auto search = MakePoseSearch(Space(), Requested(), SearchSide::kStart, to_goal);
    // The series of resolutions has half of the budget for itself. Its result does not depend on
    // the number of poses that the search at the requested resolution expands.
    const int for_series = options_.budget / 2;
    const bool goal_in_gap = SearchWhileGoalIsOpen(*search, grid, options_.budget - for_series);
    const bool series_ended = !search->has_path() && RunSeries(for_series);
    if (result_.ok() || result_.reason != "") {
      result_.expansions += search->expansions();
      return result_;
    }
    const int most = options_.budget - result_.expansions;
    while (!(series_ended && goal_in_gap) && !search->ended() && search->expansions() < most) {
      search->Advance();
    }
    result_.expansions += search->expansions();
    if (search->has_path()) {
      return Found(*search);
    }
    if (series_ended && (goal_in_gap || search->ended())) {
      return Fail(PlanStatus::kNoPath, "no feasible path");
    }
    return Fail(PlanStatus::kBudgetUsedUp,
                fmt::format("no path found in {} expansions", result_.expansions));
  }

 private:
  /// Describes the obstacle nearest to the car at `pose`, for people.
  [[nodiscard]] std::string Nearest(const Pose2& pose) const {
    return route::NearestObstacle(vehicle_, pose, problem_.obstacles, options_.safe_distance);
  }

  HybridAStarResult Fail(PlanStatus status, const std::string& reason) {
    result_.status = status;
    result_.reason = reason;
    return result_;
  }

  HybridAStarResult Enclosed() {
    return Fail(PlanStatus::kNoPath, "obstacles enclose the start or the goal");
  }

  HybridAStarResult Found(const PoseSearch& search) {
    result_.status = PlanStatus::kOk;
    result_.cost = search.cost();
    result_.segments = search.Path();
    return result_;
  }

  [[nodiscard]] SearchSpace Space() const {
    return {vehicle_, problem_, options_, radius_, clear_};
  }

  [[nodiscard]] Resolution Requested() const {
    return Resolution::WithBins(options_.cell, options_.headings, radius_);
  }

  /// Makes a grid in which a cell is occupied if the rear-axle center cannot be at any point of the
  /// cell. Every point of an occupied cell is too close to an obstacle. The minimum distance of the
  /// rear-axle center is its distance to the nearest side of the footprint, plus the required
  /// clearance.
  [[nodiscard]] std::shared_ptr<const OccupancyGrid> MakeGrid(double cell) const {
    const auto inflated_by = [&](double distance) {
      return std::max(clear_.inner_radius() + distance - 0.5 * std::sqrt(2.0) * cell, 0.0);
    };
    Inflation inflation = inflated_by(options_.safe_distance);
    for (const double distance : clear_.distances()) {
      inflation.own.push_back(inflated_by(distance));
    }
    return std::make_shared<const OccupancyGrid>(
        Rasterize(problem_.start, area_, cell, problem_.obstacles, inflation));
  }

  static std::shared_ptr<const GridDistance> DistanceTo(
      const std::shared_ptr<const OccupancyGrid>& grid, const Pose2& target) {
    return std::make_shared<const GridDistance>(grid, target.position());
  }

  /// Returns whether the grid has a path from the start to the goal.
  [[nodiscard]] bool Connects(const GridDistance& to_goal) const {
    return std::isfinite(to_goal.LowerBound(problem_.start.position()));
  }

  /// Advances a search from the start until it ends, or until it has expanded `most` poses. Stops
  /// and returns true if the goal is in an enclosed gap. The goal is in such a gap if a search from
  /// the goal, at the requested resolution, expands all reachable poses before the start's search
  /// finds a path.
  [[nodiscard]] bool SearchWhileGoalIsOpen(PoseSearch& search,
                                           const std::shared_ptr<const OccupancyGrid>& grid,
                                           int most) const {
    std::unique_ptr<PoseSearch> from_goal;
    while (!search.ended() && search.expansions() < most) {
      search.Advance();
      if (search.has_path() || search.expansions() % kPosesPerGoalPose != 0) {
        continue;
      }
      if (from_goal == nullptr) {
        from_goal = MakePoseSearch(Space(), Requested(), SearchSide::kGoal,
                                   DistanceTo(grid, problem_.start));
      }
      from_goal->Advance();
      if (from_goal->ended() && !from_goal->has_path()) {
        return true;
      }
    }
    return false;
  }

  /// Searches for a path at each resolution of the series, and sets the result if there is a path
  /// or if obstacles enclose the start or the goal. Returns whether the search at the finest
  /// resolution has ended without a path. Sets the number of expanded poses.
  bool RunSeries(int budget) {
    const auto bins = [&](int headings) { return 2.0 * kPi * radius_ / (1.5 * headings); };
    double cell = bins(kCoarsestHeadings << (kResolutions - 1));
    while (CellsIn(area_, cell) > kMaxSeriesCells) {
      cell *= 2.0;
    }
    const auto grid = MakeGrid(cell);
    const auto to_goal = DistanceTo(grid, problem_.goal);
    const auto to_start = DistanceTo(grid, problem_.start);
    if (!Connects(*to_goal)) {
      Enclosed();
      return true;
    }
    bool ended = false;
    for (int i = 0; i < kResolutions; ++i) {
      const int headings = kCoarsestHeadings << i;
      const Resolution resolution = Resolution::WithBins(bins(headings), headings, radius_);
      const auto forth = MakePoseSearch(Space(), resolution, SearchSide::kStart, to_goal);
      const auto back = MakePoseSearch(Space(), resolution, SearchSide::kGoal, to_start);
      // Finer resolutions inherit the part of the budget that coarser resolutions have not used.
      const int most = result_.expansions + (budget - result_.expansions) / (kResolutions - i);
      ended = false;
      while (!ended && result_.expansions + 2 <= most) {
        forth->Advance();
        back->Advance();
        result_.expansions += 2;
        ended = forth->ended() || back->ended();
      }
      if (forth->has_path() || back->has_path()) {
        Found(forth->cost() <= back->cost() ? *forth : *back);
        return false;
      }
    }
    return ended;
  }

  const VehicleParams& vehicle_;
  const HybridAStarProblem& problem_;
  const HybridAStarOptions& options_;
  double radius_;
  CollisionChecker clear_;
  GridArea area_;
  HybridAStarResult result_;
};

}  // namespace

HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options) {
  TRACKBED_CHECK(options.cell > 0.0 && options.headings >= 8 && options.margin >= 0.0 &&
                     options.budget >= 0 && options.radius.value_or(1.0) > 0.0 &&
                     options.weight >= 1.0 && options.reverse_cost >= 1.0 &&
                     options.switch_cost >= 0.0 && options.steering_cost >= 0.0,
                 "cells of {} m and {} headings, margin {}, budget {}, costs {}, {}, {}",
                 options.cell, options.headings, options.margin, options.budget,
                 options.reverse_cost, options.switch_cost, options.steering_cost);
  return Searches(vehicle, problem, options).Run();
}

void Visit(KeyVisitor& keys, HybridAStarOptions& options) {
  route::VisitCurves(keys, options.radius, options.safe_distance, options.min_speed);
  keys.Field({"reverse", "", "whether the path may reverse"}, options.reverse, Need::kOptional);
  keys.Field({"reverse_cost", "", "cost factor of reverse travel"}, options.reverse_cost,
             Need::kOptional, Range{.min = 1.0, .max = 1e3});
  keys.Field({"switch_cost", "m", "cost of a change of direction"}, options.switch_cost,
             Need::kOptional, kNonNegative);
  keys.Field({"steering_cost", "m", "cost of a curvature step from straight to the radius"},
             options.steering_cost, Need::kOptional, kNonNegative);
  keys.Field({"weight", "",
              "weight of the heuristic: above 1, fewer expansions, and a cost of at most `weight` "
              "times the optimum"},
             options.weight, Need::kOptional, Range{.min = 1.0, .max = 10.0});
  keys.Field(route::kGridCell, options.cell, Need::kOptional, route::kCellSize);
  keys.Field({"headings", "", "number of heading cells"}, options.headings, Need::kOptional,
             Range{.min = 8, .max = 720});
  keys.Field(route::kGridMargin, options.margin, Need::kOptional, kNonNegative);
  keys.Field({"budget", "", "maximum expanded poses per leg"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e7});
  keys.Field(kCurvatureKey, options.curvature, Need::kOptional, CurvaturesWithCusps());
  VisitClothoids(keys, options.max_lateral_acceleration, options.max_steering_rate_fraction);
}

}  // namespace trackbed
