#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/grid/hybrid_astar.h"

/// One search over poses at one resolution, from the start or from the goal. SearchHybridAStar
/// (hybrid_astar.h) combines several of these searches.
namespace trackbed {

/// Lower bounds of the length of a path to a target around the obstacles.
class GridDistance {
 public:
  /// Computes the distances from all cells of the grid to `target`, which must be on the grid.
  GridDistance(std::shared_ptr<const OccupancyGrid> grid, const Vec2& target);

  /// Returns a lower bound of the distance from a point to the target [m]; infinite if obstacles
  /// enclose the point or the target.
  [[nodiscard]] double LowerBound(const Vec2& point) const;

 private:
  std::shared_ptr<const OccupancyGrid> grid_;
  std::vector<double> distances_;  // Distances to the target, in side lengths of a cell.
};

/// Resolution of a search: its bins of poses, and its steps between poses. The search keeps one
/// pose for each bin of position and heading.
struct Resolution {
  double cell = 0.0;  ///< Side length of a position bin [m].
  int headings = 0;   ///< Number of heading bins per full turn.
  double step = 0.0;  ///< Length of the arcs [m].

  /// Returns the resolution with the shortest arcs that leave their bins: every arc is longer than
  /// a cell's diagonal, and the sharpest arc turns by a heading bin. Shorter arcs would end in the
  /// same bins as straight lines. In each bin (grid cell and heading), the search keeps only the
  /// cheapest pose, and a straight line costs less than an arc.
  static Resolution WithBins(double cell, int headings, double radius);
};

/// Side of the problem from which a search expands poses.
enum class SearchSide { kStart, kGoal };

/// The inputs that all searches for one path share. The referenced objects must outlive the
/// searches.
struct SearchSpace {
  const VehicleParams& vehicle;
  const HybridAStarProblem& problem;
  const HybridAStarOptions& options;
  double radius;  ///< Radius of the sharpest arcs [m].
  const CollisionChecker& clear;
};

/// A search that expands one pose at a time.
class PoseSearch {
 public:
  virtual ~PoseSearch() = default;

  /// Expands the next pose. Does nothing after the search has ended.
  virtual void Advance() = 0;

  /// Returns whether the best path at this resolution is known, or all poses are expanded.
  [[nodiscard]] virtual bool ended() const = 0;

  /// Returns the number of expanded poses.
  [[nodiscard]] virtual int expansions() const = 0;

  /// Returns the cost of the cheapest path found so far; infinite before the first path.
  [[nodiscard]] virtual double cost() const = 0;

  /// Returns the segments of the cheapest path, driven from the start to the goal.
  [[nodiscard]] virtual std::vector<Segment> Path() const = 0;

  [[nodiscard]] bool has_path() const { return cost() < std::numeric_limits<double>::infinity(); }
};

/// Makes a search. The argument `left` contains the grid distances to the target of the search: the
/// goal or, for a search from the goal, the start.
std::unique_ptr<PoseSearch> MakePoseSearch(const SearchSpace& space, const Resolution& resolution,
                                           SearchSide side,
                                           std::shared_ptr<const GridDistance> left);

}  // namespace trackbed
