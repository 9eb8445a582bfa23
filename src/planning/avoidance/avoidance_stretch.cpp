#include "src/planning/avoidance/avoidance_stretch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/road_hold.h"
#include "trackbed/world/world.h"

// Finds the stretch of a plan that is replaced by a curve past an obstacle. RRT* (Karaman and
// Frazzoli 2011) finds a path on each side of the obstacle. Nested loops try the demands
// (comfortable first, then slower), the two sides of the obstacle, and the stations at which the
// curve may leave the plan. For each combination, the search tries the stations at which the curve
// may return to the plan, the nearest first. Fit makes an initial curve along the path of RRT*, and
// RepairCurve makes the curve feasible. After the first feasible curve, the search tries to return
// at earlier stations until a curve is infeasible.

namespace trackbed::avoidance {
namespace {

/// Spacing of the stations at which a curve may return to the path [m]. After a bend, the spacing
/// of the return stations is doubled.
constexpr double kReturnStep = 2.0;
/// Ratio of each speed that the search tries to the previous speed.
constexpr double kSpeedRatio = 0.6;
/// Tolerance for approximating a curve by path pieces [m]. Without this approximation tolerance, a
/// curve that keeps exactly the safe distance SD could count as a conflict.
constexpr double kRoundingTolerance = 5e-4;

double HalfDiagonal(const OrientedBox& box) {
  return 0.5 * std::hypot(box.length, box.width);
}

std::vector<PathPoint> SamplePoints(const Path& path, double from, double to) {
  std::vector<PathPoint> points;
  const double count = std::max(1.0, std::ceil((to - from) / kPathCheckSpacing));
  for (double i = 0.0; i <= count; i += 1.0) {
    points.push_back(path.At(std::lerp(from, to, i / count)));
  }
  return points;
}

/// A bend of the path: a stretch on which the curvature keeps its sign and is at least a tenth of
/// its peak value.
struct Bend {
  double from = 0.0;  ///< Station at which the bend begins [m].
  double to = 0.0;    ///< Station at which the bend ends [m].
  /// Signed curvature at the point of the bend with the largest |curvature| [1/m].
  double curvature = 0.0;
};

/// One side of an obstacle, and the path that RRT* found on this side.
struct SidePath {
  PassingSide passing_side = PassingSide::kInner;
  RrtStarResult tree;
};

/// A demand: the speed and the share of the steering rate that a curve may use.
struct Demand {
  double speed = 0.0;  ///< Speed of the car on the curve [m/s].
  double share = 1.0;  ///< Fraction of the car's maximum steering rate that the curve may use.
};

class StretchFinder {
 public:
  StretchFinder(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                const Plan& plan)
      : request_(request),
        options_(options),
        plan_(plan),
        road_(RequestOn(request.road, request.vehicle, request.speed)) {}

  [[nodiscard]] StretchSearch Find(const Conflict& conflict, double from) const {
    const Bend bend = BendAt(conflict);
    const std::vector<double> leaves = DepartureStations(conflict, bend, from);
    const std::vector<double> backs = ReturnStations(conflict, bend);
    if (backs.empty()) {
      return {std::nullopt, "the path ends beside the obstacle"};
    }
    const double full = request_.speed.speed;
    const double beside = StationBeside(path(), request_.vehicle, conflict);
    const std::vector<SidePath> side_paths =
        FindSidePaths(conflict, bend, ProblemFor(leaves.front(), backs.back(), {full, 1.0}, from));
    int tried = 0;
    for (const Demand& demand : Demands()) {
      for (const SidePath& side_path : side_paths) {
        if (demand.speed < full && side_path.tree.status == RrtStarStatus::kNotReached) {
          // Skip a side of the obstacle on which RRT* found no path, because a lower speed does not
          // help.
          continue;
        }
        for (const double leave : leaves) {
          // Sets up the problem of a curve from station `leave` to station `back` for the demand.
          const auto problem_to = [&](double back) {
            CurveProblem problem = ProblemFor(leave, back, demand, from);
            problem.passage = {SideFrame(conflict), LateralSign(bend, side_path.passing_side)};
            problem.mirror = LateralSign(bend, PassingSide::kInner);
            return problem;
          };
          std::optional<Stretch> stretch;
          const auto attempt = [&](double back, const BezierCurve& guess) {
            const CurveProblem problem = problem_to(back);
            ++tried;
            std::optional<Repair> repair =
                RepairCurve(problem, guess, options_.search, request_.seed);
            if (repair) {
              stretch = Stretch{problem, std::move(*repair), side_path.passing_side, leave,
                                back,    side_path.tree,     conflict.obstacle,      beside,
                                0};
            }
            return repair.has_value();
          };
          for (auto back = backs.begin(); back != backs.end() && !stretch; ++back) {
            const CurveProblem problem = problem_to(*back);
            if (!attempt(*back, Fit(problem, Guide(side_path, conflict, bend, problem)))) {
              continue;
            }
            // Start the search at the feasible curve, which is a better initial guess than the
            // fitted curve.
            for (auto earlier = back; earlier != backs.begin();) {
              --earlier;
              if (!attempt(*earlier, stretch->repair.curve)) {
                break;
              }
            }
          }
          if (stretch) {
            stretch->tried = tried;
            return {stretch, ""};
          }
        }
      }
    }
    const std::string why =
        fmt::format("no feasible curve on {} at {:.3g} m/s or more ({} tried)",
                    options_.passing_side == PassingSideChoice::kAuto
                        ? "either side"
                        : fmt::format("the {} side", ToString(side_paths.front().passing_side)),
                    std::min(full, options_.min_speed), tried);
    return {std::nullopt, why};
  }

 private:
  [[nodiscard]] const Path& path() const { return plan_.reference.path; }

  /// Returns the bend in which a conflict with an obstacle lies; for a conflict on a straight,
  /// returns the stretch of the conflict.
  [[nodiscard]] Bend BendAt(const Conflict& conflict) const {
    Bend bend{conflict.from, conflict.to, 0.0};
    for (const PathPoint& point : SamplePoints(path(), conflict.from, conflict.to)) {
      if (std::abs(point.curvature) > std::abs(bend.curvature)) {
        bend = {point.s, point.s, point.curvature};
      }
    }
    if (bend.curvature == 0.0) {
      return bend;
    }
    const auto is_in_bend = [&](double s) {
      return path().At(s).curvature * bend.curvature > 0.1 * bend.curvature * bend.curvature;
    };
    while (bend.from - kPathCheckSpacing >= 0.0 && is_in_bend(bend.from - kPathCheckSpacing)) {
      bend.from -= kPathCheckSpacing;
    }
    while (bend.to + kPathCheckSpacing <= path().length() &&
           is_in_bend(bend.to + kPathCheckSpacing)) {
      bend.to += kPathCheckSpacing;
    }
    return bend;
  }

  /// Returns the distance that the car needs along the path to shift sideways past the obstacle
  /// [m]. For a quintic lateral shift by D over the length l, dkappa/ds is largest at both ends and
  /// equals 60 D/l^3 there. The car's maximum steering rate limits dkappa/ds.
  [[nodiscard]] double ShiftLength(const OrientedBox& obstacle) const {
    const double aside =
        HalfDiagonal(obstacle) + options_.safe_distance + 0.5 * request_.vehicle.width;
    const double sharpness = options_.max_steering_rate_fraction * request_.vehicle.steering_rate /
                             (request_.vehicle.wheelbase * request_.speed.speed);
    return std::cbrt(60.0 * aside / sharpness);
  }

  /// Returns how far the curve extends beyond the bend at both ends. On a straight, this distance
  /// is the length of the lateral shift.
  [[nodiscard]] double LeadDistance(const Bend& bend, const OrientedBox& obstacle) const {
    const double delay = request_.speed.speed * options_.delay;
    return bend.curvature != 0.0 ? 1.0 / std::abs(bend.curvature) + delay
                                 : ShiftLength(obstacle) + delay;
  }

  /// Returns whether the scheduled steering angle matches the path's curvature. Steering angle and
  /// curvature differ only on steering ramps.
  [[nodiscard]] bool IsSteeringSettled(double s) const {
    const double planned = SteeringForCurvature(request_.vehicle, path().At(s).curvature);
    constexpr double kSteeringTolerance = 1e-3;  // [rad]
    return std::abs(plan_.schedule.At(s) - planned) < kSteeringTolerance;
  }

  /// Returns the station in [from, to] nearest to s at which the steering is settled. If the
  /// steering is settled nowhere in [from, to], returns the station s clamped to [from, to].
  [[nodiscard]] double SettledNear(double s, double from, double to) const {
    for (double away = 0.0; s - away >= from || s + away <= to; away += kPathCheckSpacing) {
      for (const double candidate : {s - away, s + away}) {
        if (candidate >= from && candidate <= to && IsSteeringSettled(candidate)) {
          return candidate;
        }
      }
    }
    return std::clamp(s, from, to);
  }

  /// Returns the stations at which the curve may leave the plan, the preferred station first.
  [[nodiscard]] std::vector<double> DepartureStations(const Conflict& conflict, const Bend& bend,
                                                      double from) const {
    std::vector<double> leaves;
    const double lead = LeadDistance(bend, conflict.obstacle);
    for (const double share : {1.0, 1.5, 2.25}) {
      const double wanted = bend.from - share * lead;
      // A curve that begins at the car's present position may begin while the steering angle is
      // still changing; any other curve begins where the steering is settled, if possible.
      const double s = request_.car && wanted <= 0.0 ? 0.0
                                                     : SettledNear(std::max(wanted, from), from,
                                                                   std::max(from, conflict.from));
      if (leaves.empty() || s < leaves.back() - kReturnStep) {
        leaves.push_back(s);
      }
    }
    return leaves;
  }

  /// Returns the stations at which the curve may return to the plan, in ascending order.
  [[nodiscard]] std::vector<double> ReturnStations(const Conflict& conflict,
                                                   const Bend& bend) const {
    const double lead = LeadDistance(bend, conflict.obstacle);
    const double last = std::min(path().length(), std::max(bend.to, conflict.to) + 2.0 * lead);
    std::vector<double> backs;
    for (double s = conflict.to + kReturnStep; s < last;
         s += s < bend.to + lead ? kReturnStep : 2.0 * kReturnStep) {
      if (IsSteeringSettled(s)) {
        backs.push_back(s);
      }
    }
    if (last == path().length() && last > conflict.to) {
      backs.push_back(last);
    }
    return backs;
  }

  [[nodiscard]] CurveProblem ProblemFor(double leave, double back, const Demand& demand,
                                        double from) const {
    const PathPoint start = path().At(leave);
    const PathPoint end = path().At(back);
    CurveProblem problem{.vehicle = request_.vehicle,
                         .start = {start.pose, start.curvature},
                         .end = {end.pose, end.curvature},
                         .obstacles = request_.obstacles,
                         .safe_distance = options_.safe_distance,
                         .steering_rate = demand.share * request_.vehicle.steering_rate,
                         .lateral_acceleration = options_.max_lateral_acceleration,
                         .start_speed = plan_.reference.speed.SpeedAt(leave),
                         .speed = demand.speed,
                         .deceleration = request_.speed.deceleration};
    // The car may brake before the start of the curve.
    const double before = plan_.reference.speed.SpeedAt(from);
    LowerToRoad(problem, {std::min(from, leave), back});
    const double square = before * before - 2.0 * problem.deceleration * (leave - from);
    problem.start_speed =
        std::min(problem.start_speed, std::sqrt(std::max(square, demand.speed * demand.speed)));
    if (request_.car && leave == 0.0) {
      problem.start = {request_.car->pose,
                       CurvatureForSteering(request_.vehicle, request_.car->steering)};
    }
    return problem;
  }

  /// Lowers the limits for the curve to what the road under the replaced part of the path permits.
  /// MakeFeasible later checks the curve itself, which may cross a patch with another friction
  /// coefficient beside the path.
  void LowerToRoad(CurveProblem& problem, const Stations& within) const {
    const RoadHoldLimits hold = MinRoadHold(path(), within, road_);
    if (hold.lateral > 0.0) {
      problem.lateral_acceleration = std::min(problem.lateral_acceleration, hold.lateral);
    }
    if (hold.braking > 0.0) {
      problem.deceleration = std::min(problem.deceleration, hold.braking);
    }
  }

  /// Returns the side of the path at the obstacle on which `passing_side` lies: +1 for left, -1 for
  /// right.
  [[nodiscard]] static double LateralSign(const Bend& bend, PassingSide passing_side) {
    const double inner = bend.curvature < 0.0 ? -1.0 : 1.0;
    return passing_side == PassingSide::kInner ? inner : -inner;
  }

  /// Returns the frame that defines the two sides of the obstacle. The frame's origin is the
  /// obstacle's center, and its x axis points along the adjacent path.
  [[nodiscard]] Pose2 SideFrame(const Conflict& conflict) const {
    return {conflict.obstacle.center.x, conflict.obstacle.center.y,
            path().At(StationBeside(path(), request_.vehicle, conflict)).pose.yaw};
  }

  /// Returns the demands in the order in which the search tries them. The first demand is
  /// comfortable; it combines the mission's speed with a fraction of the steering rate. All later
  /// demands use the full steering rate, at speeds that fall to the slowest allowed speed.
  [[nodiscard]] std::vector<Demand> Demands() const {
    const double most = options_.max_steering_rate_fraction;
    std::vector<Demand> demands;
    if (options_.comfortable_steering_rate_fraction < most) {
      demands.push_back({request_.speed.speed, options_.comfortable_steering_rate_fraction});
    }
    for (double v = request_.speed.speed; v > options_.min_speed; v *= kSpeedRatio) {
      demands.push_back({v, most});
    }
    demands.push_back({std::min(request_.speed.speed, options_.min_speed), most});
    return demands;
  }

  /// Sets up the RRT* problem of a path from the start of the curve to its end.
  [[nodiscard]] RrtStarProblem TreeProblem(const MirrorFrame& frame, const CurveProblem& problem,
                                           const Conflict& conflict) const {
    RrtStarProblem tree{.start = {0.0, 0.0},
                        .goal = frame.In(problem.end.pose.position()),
                        .inflation = options_.safe_distance + 0.5 * request_.vehicle.width};
    for (const OrientedBox& obstacle : request_.obstacles) {
      tree.obstacles.push_back(frame.In(obstacle));
    }
    const double around = HalfDiagonal(conflict.obstacle) + 2.0 * tree.inflation.most;
    const Vec2 center = frame.In(conflict.obstacle.center.position());
    const Vec2 margin = Vec2::Constant(tree.inflation.most);
    tree.low = tree.start.cwiseMin(tree.goal).cwiseMin(center - Vec2::Constant(around)) - margin;
    tree.high = tree.start.cwiseMax(tree.goal).cwiseMax(center + Vec2::Constant(around)) + margin;
    return tree;
  }

  /// Returns a thin wall from the obstacle outward, which blocks one side of the obstacle for RRT*.
  [[nodiscard]] static OrientedBox WallOn(const PassageConstraint& passage, double length) {
    constexpr double kWallThickness = 1e-3;  // [m]
    const Vec2 middle = ToWorld(passage.frame, {0.0, passage.side * 0.5 * length});
    return {{middle.x(), middle.y(), passage.frame.yaw}, kWallThickness, length};
  }

  /// Returns the sides of the obstacle that the search tries, each with the path that RRT* found on
  /// this side. The side with the shorter RRT* path comes first.
  [[nodiscard]] std::vector<SidePath> FindSidePaths(const Conflict& conflict, const Bend& bend,
                                                    const CurveProblem& problem) const {
    const Pose2 beside = SideFrame(conflict);
    const MirrorFrame frame{problem.start.pose, LateralSign(bend, PassingSide::kInner)};
    const auto grow = [&](std::optional<PassingSide> only) {
      RrtStarProblem tree = TreeProblem(frame, problem, conflict);
      if (only) {
        const PassingSide closed =
            *only == PassingSide::kInner ? PassingSide::kOuter : PassingSide::kInner;
        const double length = (tree.high - tree.low).norm();
        tree.obstacles.push_back(frame.In(WallOn({beside, LateralSign(bend, closed)}, length)));
      }
      RrtStarResult result = PlanRrtStar(
          tree, {.iterations = options_.rrt_iterations, .step = options_.rrt_step}, request_.seed);
      for (Vec2& point : result.path) {
        point = frame.Out(point);
      }
      for (TreeNode& node : result.nodes) {
        node.position = frame.Out(node.position);
      }
      return result;
    };
    if (options_.passing_side != PassingSideChoice::kAuto) {
      const PassingSide passing_side = options_.passing_side == PassingSideChoice::kInner
                                           ? PassingSide::kInner
                                           : PassingSide::kOuter;
      return {{passing_side, grow(passing_side)}};
    }
    SidePath first{PassingSide::kInner, grow(std::nullopt)};
    if (first.tree.ok()) {
      const bool left = GoesThrough({beside, 1.0}, first.tree.path);
      first.passing_side = (left ? 1.0 : -1.0) == LateralSign(bend, PassingSide::kInner)
                               ? PassingSide::kInner
                               : PassingSide::kOuter;
    }
    const PassingSide other =
        first.passing_side == PassingSide::kInner ? PassingSide::kOuter : PassingSide::kInner;
    return {first, {other, grow(other)}};
  }

  /// Returns the polyline to which Fit fits the initial curve: the path of RRT* up to its point
  /// closest to the end of the curve. If RRT* found no path, the polyline passes through a point
  /// beside the obstacle.
  [[nodiscard]] std::vector<Vec2> Guide(const SidePath& side_path, const Conflict& conflict,
                                        const Bend& bend, const CurveProblem& problem) const {
    const Vec2 end = problem.end.pose.position();
    std::vector<Vec2> guide;
    if (side_path.tree.ok()) {
      const auto nearest = std::min_element(
          side_path.tree.path.begin() + 1, side_path.tree.path.end(),
          [&](const Vec2& a, const Vec2& b) { return (a - end).norm() < (b - end).norm(); });
      guide.assign(side_path.tree.path.begin(), nearest);
    } else {
      const double aside =
          HalfDiagonal(conflict.obstacle) + options_.safe_distance + request_.vehicle.width;
      guide = {
          problem.start.pose.position(),
          ToWorld(SideFrame(conflict), {0.0, LateralSign(bend, side_path.passing_side) * aside})};
    }
    guide.push_back(end);
    return guide;
  }

  const AvoidanceRequest& request_;
  const BezierAvoidanceOptions& options_;
  const Plan& plan_;
  PlanRequest road_;
};

}  // namespace

std::optional<Conflict> FirstConflict(const AvoidanceRequest& request, double safe_distance,
                                      const Path& path, double from) {
  std::optional<Conflict> conflict;
  for (const PathPoint& point : SamplePoints(path, from, path.length())) {
    const OrientedBox footprint = FootprintAt(request.vehicle, point.pose);
    const auto in_the_way = std::find_if(
        request.obstacles.begin(), request.obstacles.end(), [&](const OrientedBox& obstacle) {
          return Separation(footprint, obstacle) < safe_distance - kRoundingTolerance;
        });
    if (in_the_way != request.obstacles.end()) {
      if (!conflict) {
        conflict = {point.s, point.s, *in_the_way};
      }
      conflict->to = point.s;
    } else if (conflict) {
      break;
    }
  }
  return conflict;
}

double StationBeside(const Path& path, const VehicleParams& vehicle, const Conflict& conflict) {
  const Pose2 at{conflict.obstacle.center.x, conflict.obstacle.center.y, 0.0};
  return path.Project(at, {conflict.from, conflict.to + vehicle.length}).s;
}

StretchSearch FindStretch(const AvoidanceRequest& request, const BezierAvoidanceOptions& options,
                          const Plan& plan, const Conflict& conflict, double from) {
  return StretchFinder(request, options, plan).Find(conflict, from);
}

}  // namespace trackbed::avoidance
