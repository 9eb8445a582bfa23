#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan_status.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/curves/drivable_curve.h"
#include "trackbed/vehicle/params.h"

/// Plans paths by Hybrid A* (Dolgov et al. 2008), a search over the poses that a car can reach by
/// driving forwards and backwards. The poses are not rounded to a grid. The search keeps only the
/// cheapest pose for each cell of position and heading, and for each direction of travel.
///
/// Symbols: r is the radius of the sharpest arcs [m]. Each step of the search is an arc of
/// curvature 0, +-1/(2r) or +-1/r, with the smallest radius r. The cost of a path is its length
/// [m], where reverse stretches count `reverse_cost` times. Every change of direction adds
/// `switch_cost` to the cost of the path. Every joint between arcs adds `steering_cost` times the
/// change of curvature, relative to the largest curvature 1/r, to the cost. The search estimates
/// the cost from a pose to the goal as the larger of two lengths: the length of the shortest
/// Reeds-Shepp curve, and the length of the shortest grid path around the obstacles, divided by
/// 1.0824. The divisor 1.0824 is needed because a path on an empty grid is up to 1.0824 times as
/// long as a straight line.
///
/// Steps of the search are as long as the larger of 1.5 cells and an arc of radius r over one
/// heading cell. With steps of this length, no step of the largest curvature 1/r ends in the same
/// cell as a straight step. If the search with the requested cells finds no path, other searches
/// follow with a fixed series of cell sizes, from the start and from the goal. The series of cell
/// sizes depends only on the smallest radius and on the problem, so that a request for finer cells
/// or headings never loses a path that the series finds.
///
/// With clothoids (CurveCurvature::kContinuous and kCuspSteps), the curvature of the path is
/// continuous. With clothoids, the state of the search includes the curvature. Each step of a
/// search with clothoids is an arc of the present curvature, or a clothoid to the next of the five
/// curvatures 0, +-1/(2r) and +-1/r. Each clothoid is as long as the steering needs at one of a few
/// speeds, from the speed v of the mission down to the lowest speed. With clothoids, the last curve
/// of the path, which ends at the goal, is a curve of continuous curvature (continuous_curvature.h)
/// for one of the clothoids' speeds. Where the car drives at a speed w below the mission's speed v,
/// the cost of the path is multiplied by v/w. Each change of speed and each turn of the wheels at
/// rest adds a cost: the distance that the car would drive at the speed v in the lost time. If the
/// search finds the first path after n expansions, the search ends after at most n + 1500 further
/// expansions. Because the number of expansions after the first path is limited, the cost of the
/// path may exceed `weight` times the optimum.
namespace trackbed {

struct HybridAStarOptions {
  /// Radius r of the sharpest arcs [m]; none: 1.1 times the car's smallest turning radius.
  std::optional<double> radius;
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  bool reverse = true;         ///< Whether the car may drive backwards.
  double reverse_cost = 2.0;   ///< Cost of driving one meter backwards, >= 1.
  double switch_cost = 5.0;    ///< Cost of a change between forward and backward driving [m], >= 0.
  double steering_cost = 2.0;  ///< Cost of a change of curvature by 1/r at a joint [m], >= 0.
  /// Weight of the estimated cost to the goal, >= 1. With a weight above 1, the search expands
  /// fewer poses, and the found path costs at most `weight` times as much as the optimum.
  double weight = 2.0;
  double cell = 0.5;       ///< Side length of a position cell of the first search [m], > 0.
  int headings = 72;       ///< Number of heading cells of the first search per full turn, >= 8.
  double margin = 10.0;    ///< Margin of the search area around start, goal and obstacles [m].
  double min_speed = 0.3;  ///< Lowest speed of the car at a step of curvature [m/s].
  int budget = 200000;     ///< Maximum number of poses that all searches may expand, >= 0.
  /// How the curvature of the path may change. With kAuto, the planner searches for a path with
  /// curvature steps only at cusps (kCuspSteps), and with kSteps if the car cannot drive such a
  /// path. SearchHybridAStar itself treats kAuto as kSteps.
  CurveCurvature curvature = CurveCurvature::kAuto;
  /// Largest lateral acceleration on paths of continuous curvature [m/s^2], > 0; half of the tyres'
  /// grip is another limit.
  double max_lateral_acceleration = 3.0;
  /// Fraction of the car's steering rate that paths of continuous curvature use, in (0, 1]. The
  /// remaining steering rate is left for the corrections of controllers close to obstacles.
  double max_steering_rate_fraction = 0.6;
};
void Visit(KeyVisitor& keys, HybridAStarOptions& options);

/// Speeds and limits with which the car drives a path of continuous curvature.
struct ClothoidDrive {
  double speed = 1.0;                 ///< Speed v of the mission [m/s], > 0.
  double min_speed = 0.3;             ///< Lowest speed on clothoids [m/s], > 0.
  double steering_rate = 1.0;         ///< Largest rate of the steering angle [rad/s], > 0.
  double lateral_acceleration = 3.0;  ///< Largest lateral acceleration [m/s^2], > 0.
  double acceleration = 1.0;          ///< Acceleration of the speed profile [m/s^2], > 0.
  double deceleration = 1.0;          ///< Deceleration of the speed profile [m/s^2], > 0.
  double start_speed = 0.0;           ///< Speed at the start, forwards [m/s], >= 0.
  double start_curvature = 0.0;       ///< Curvature of the path at the start [1/m].
  bool rests_at_start = false;        ///< Whether the car may turn its wheels at rest at the start.
  bool rests_at_goal = false;         ///< Whether the car may turn its wheels at rest at the goal.
};

struct HybridAStarProblem {
  Pose2 start;
  Pose2 goal;
  std::vector<OrientedBox> obstacles{};
  /// Whether the car rolls forwards at the start, so that the path cannot begin backwards.
  bool rolls = false;
  /// Speeds and limits with which the car drives the last curve of the path. If `drive` is set,
  /// gentler arcs replace short arcs of the last curve (drivable_curve.h). If `drive` is empty, the
  /// last curve is a Reeds-Shepp or Dubins curve.
  std::optional<CurveDrive> drive{};
  ClothoidDrive clothoids{};  ///< Speeds and limits on a path of continuous curvature.
};

struct HybridAStarResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string reason;  ///< Reason why the search failed; empty if ok.
  /// Path segments from the start pose; empty if the search failed.
  std::vector<Segment> segments;
  double cost = std::numeric_limits<double>::infinity();
  int expansions = 0;  ///< Number of poses that all searches expanded.
  int cells = 0;       ///< Number of position cells of the search area.

  [[nodiscard]] bool ok() const { return status == PlanStatus::kOk; }
};

/// Searches for a path by Hybrid A*. Guarantees for the status kOk: the path ends within 1e-9 m and
/// 1e-9 rad of the goal pose. The last part of the path is a Reeds-Shepp curve, or a Dubins curve
/// if the car may not drive backwards. If the search from the goal found the path, the Reeds-Shepp
/// or Dubins curve is the first part of the path instead. If the problem has `drive`, gentler arcs
/// replace those arcs of the Reeds-Shepp or Dubins curve that are too short for the steering. The
/// curvature of the path never exceeds 1/r, with the radius r of the sharpest arcs. With clothoids,
/// the last or first part of the path is instead a curve of continuous curvature. A path with
/// clothoids begins with the curvature `start_curvature` and ends with straight wheels. With
/// kContinuous, the path's curvature has no steps. With kCuspSteps, the path's curvature may only
/// step at cusps, and at a start or goal where the car rests. On the whole path, the car's
/// footprint is clear of all obstacles (CollisionChecker). The same input always yields the same
/// result. The path is not globally optimal, because the search keeps only one pose per cell, and
/// because the path must contain a Reeds-Shepp or Dubins curve. If the budget is used up, the
/// function returns the best path found so far. Half of the budget is reserved for the searches
/// with other cell sizes, unless the search with the requested cells finds a path with the other
/// half. The status is kNoPath if obstacles enclose the start or the goal, or if there is no path
/// even with the shortest steps, 0.016 times the radius r of the sharpest arcs. The searches return
/// kNoPath only after they have expanded all poses around the start or around the goal. Throws
/// InternalError if an option is out of range. Computing time: about 10 us per expanded pose, 100
/// us with clothoids.
HybridAStarResult SearchHybridAStar(const VehicleParams& vehicle, const HybridAStarProblem& problem,
                                    const HybridAStarOptions& options);

}  // namespace trackbed
