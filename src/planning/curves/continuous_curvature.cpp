#include "trackbed/planning/curves/continuous_curvature.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <set>
#include <string>

#include "src/planning/curves/continuous_words.h"
#include "src/planning/curves/sharp_turns.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Turns by which the car can leave a state, at most six for each direction.
using Ends = boost::container::static_vector<TurnEnd, 12>;

Ends EndsOf(const TurnCircle& circle, const CurveState& state, int direction, bool both_ways) {
  Ends ends;
  const int own = state.curvature < 0.0 ? -1 : 1;
  for (const int way : {direction, -direction}) {
    if (way != direction && !both_ways) {
      continue;
    }
    for (const int side : {1, -1}) {
      ends.push_back(LeaveDirectly(circle, state, side, way));
    }
    if (state.curvature == 0.0) {
      continue;
    }
    ends.push_back(LeaveAfter(circle, state, 0.0, way, own, way));
    if (both_ways) {
      ends.push_back(LeaveAfter(circle, state, own, -way, own, way));
      ends.push_back(LeaveAfter(circle, state, 0.0, -way, own, way));
      ends.push_back(LeaveAfter(circle, state, 0.0, -way, -own, way));
    }
  }
  return ends;
}

/// The start and the goal in the frame of the start, in units of the radius.
struct CurveTask {
  CurveTask(const CurveLimits& limits, const CurveState& from, const CurveState& to) {
    const double r = limits.radius;
    // Upper bound of distances in radii, small enough that its square is finite.
    constexpr double kMaxDistance = 1e100;
    const Vec2 local = ToLocal(from.pose, to.pose.position()) / r;
    TRACKBED_REQUIRE(local.norm() <= kMaxDistance && std::isfinite(to.pose.yaw - from.pose.yaw),
                     "a curve from {}, {}, yaw {} to {}, {}, yaw {}; must be finite", from.pose.x,
                     from.pose.y, from.pose.yaw, to.pose.x, to.pose.y, to.pose.yaw);
    start.curvature = Checked(from.curvature, r);
    goal = {{local.x(), local.y(), to.pose.yaw - from.pose.yaw}, Checked(to.curvature, r)};
  }

  /// Returns the curvature in units of 1/r, which may exceed 1 by rounding.
  static double Checked(double curvature, double radius) {
    constexpr double kRounding = 1e-9;
    const double units = curvature * radius;
    TRACKBED_REQUIRE(std::abs(units) <= 1.0 + kRounding,
                     "a curve of the radius {} m from or to the curvature {} 1/m; must be at most "
                     "{} 1/m",
                     radius, curvature, 1.0 / radius);
    return std::clamp(units, -1.0, 1.0);
  }

  [[nodiscard]] bool IsSolved() const {
    return goal.pose.position().norm() <= kTurnRounding &&
           std::abs(WrapAngle(goal.pose.yaw)) <= kTurnRounding &&
           std::abs(goal.curvature - start.curvature) <= kTurnRounding;
  }

  CurveState start;
  CurveState goal;
};

/// Returns the state as seen by a car that drives backwards: mirrored at the y axis.
CurveState Backwards(const CurveState& state) {
  return {{-state.pose.x, state.pose.y, -state.pose.yaw}, state.curvature};
}

ShortestCurve Backwards(ShortestCurve curve) {
  for (int i = 0; i < curve.count; ++i) {
    CurvePiece& piece = curve.pieces[static_cast<std::size_t>(i)];
    piece.sweep = -piece.sweep;
    piece.ramps.direction = -piece.ramps.direction;
  }
  return curve;
}

/// Returns the shortest curve that consists of a turn, a straight and a turn, all of the largest
/// sharpness. The motion determines the permitted directions of driving.
ShortestCurve SharpCurve(const TurnCircle& circle, CurveMotion motion, const CurveTask& problem,
                         double limit) {
  ShortestCurve curve = SharpWord(circle, problem.start.curvature, problem.goal, limit);
  if (motion != CurveMotion::kForwards) {
    const ShortestCurve back = SharpWord(circle, problem.start.curvature, Backwards(problem.goal),
                                         std::min(limit, curve.length));
    if (back.length < curve.length) {
      curve = Backwards(back);
    }
  }
  return curve;
}

void ToMeters(ShortestCurve& curve, double radius) {
  curve.radius = radius;
  curve.length *= radius;
}

/// Returns the kinds of motion (CurveMotion) that a car may use in a curve. A car whose curvature
/// may step at cusps may also drive curves without such steps.
boost::container::static_vector<CurveMotion, 2> MotionsOf(CurveMotion motion) {
  boost::container::static_vector<CurveMotion, 2> motions{motion};
  if (motion == CurveMotion::kHybrid) {
    motions.push_back(CurveMotion::kContinuous);
  }
  return motions;
}

ShortestCurve Shortest(const TurnCircle& circle, CurveMotion motion, const CurveTask& problem,
                       double radius) {
  ShortestCurve curve;
  if (!problem.IsSolved()) {
    const bool both_ways = motion != CurveMotion::kForwards;
    const Ends starts = EndsOf(circle, problem.start, 1, both_ways);
    const Ends goals = EndsOf(circle, problem.goal, -1, both_ways);
    TurnChain best;
    for (const CurveMotion own : MotionsOf(motion)) {
      ChainFinder(circle, own)
          .Find(
              starts, goals, [&] { return best.length; },
              [&](const TurnChain& chain) { best = chain; });
    }
    curve = SharpCurve(circle, motion, problem, best.length);
    if (best.length <= curve.length) {
      curve = ChainCurve(circle, best, both_ways);
    }
  }
  ToMeters(curve, radius);
  return curve;
}

/// Returns the shortest curve for each sequence of turn sides and directions of motion, the
/// shortest curve first. Leaves out curves of the length `limit` or more.
std::vector<ShortestCurve> AllWords(const TurnCircle& circle, CurveMotion motion,
                                    const CurveTask& problem, double limit) {
  if (problem.IsSolved()) {
    return {ShortestCurve{}};
  }
  const bool both_ways = motion != CurveMotion::kForwards;
  const Ends starts = EndsOf(circle, problem.start, 1, both_ways);
  const Ends goals = EndsOf(circle, problem.goal, -1, both_ways);
  const ChainFinder finder(circle, motion);
  std::vector<ShortestCurve> curves;
  finder.Find(
      starts, goals, [limit] { return limit; },
      [&](const TurnChain& chain) { curves.push_back(ChainCurve(circle, chain, both_ways)); });
  const ShortestCurve sharp = SharpCurve(circle, motion, problem, limit);
  if (sharp.length < kNoCurve) {
    curves.push_back(sharp);
  }
  std::stable_sort(
      curves.begin(), curves.end(),
      [](const ShortestCurve& a, const ShortestCurve& b) { return a.length < b.length; });
  std::set<std::string> words;
  std::erase_if(curves,
                [&](const ShortestCurve& curve) { return !words.insert(CurveWord(curve)).second; });
  return curves;
}

std::vector<ShortestCurve> InMeters(std::vector<ShortestCurve> curves, double radius) {
  for (ShortestCurve& curve : curves) {
    ToMeters(curve, radius);
  }
  return curves;
}

}  // namespace

ContinuousCurves::ContinuousCurves(const CurveLimits& limits) : limits_(limits) {
  const double sharpness = limits.sharpness * limits.radius * limits.radius;
  TRACKBED_CHECK(
      limits.radius > 0.0 && limits.sharpness > 0.0 && std::isfinite(sharpness) && sharpness > 0.0,
      "radius {}, sharpness {}", limits.radius, limits.sharpness);
  circle_ = MakeTurnCircle(sharpness);
}

ShortestCurve ContinuousCurves::Dubins(const CurveState& from, const CurveState& to) const {
  return Shortest(circle_, CurveMotion::kForwards, CurveTask(limits_, from, to), limits_.radius);
}

std::vector<ShortestCurve> ContinuousCurves::DubinsWords(const CurveState& from,
                                                         const CurveState& to) const {
  return DubinsWords(from, to, kNoCurve);
}

std::vector<ShortestCurve> ContinuousCurves::DubinsWords(const CurveState& from,
                                                         const CurveState& to,
                                                         double longest) const {
  return InMeters(AllWords(circle_, CurveMotion::kForwards, CurveTask(limits_, from, to),
                           longest / limits_.radius),
                  limits_.radius);
}

ShortestCurve ContinuousCurves::ReedsShepp(const CurveState& from, const CurveState& to) const {
  return Shortest(circle_, CurveMotion::kContinuous, CurveTask(limits_, from, to), limits_.radius);
}

std::vector<ShortestCurve> ContinuousCurves::ReedsSheppWords(const CurveState& from,
                                                             const CurveState& to) const {
  return ReedsSheppWords(from, to, kNoCurve);
}

std::vector<ShortestCurve> ContinuousCurves::ReedsSheppWords(const CurveState& from,
                                                             const CurveState& to,
                                                             double longest) const {
  return InMeters(AllWords(circle_, CurveMotion::kContinuous, CurveTask(limits_, from, to),
                           longest / limits_.radius),
                  limits_.radius);
}

ShortestCurve ContinuousCurves::HybridReedsShepp(const CurveState& from,
                                                 const CurveState& to) const {
  return Shortest(circle_, CurveMotion::kHybrid, CurveTask(limits_, from, to), limits_.radius);
}

std::vector<ShortestCurve> ContinuousCurves::HybridReedsSheppWords(const CurveState& from,
                                                                   const CurveState& to) const {
  return HybridReedsSheppWords(from, to, kNoCurve);
}

std::vector<ShortestCurve> ContinuousCurves::HybridReedsSheppWords(const CurveState& from,
                                                                   const CurveState& to,
                                                                   double longest) const {
  return InMeters(AllWords(circle_, CurveMotion::kHybrid, CurveTask(limits_, from, to),
                           longest / limits_.radius),
                  limits_.radius);
}

}  // namespace trackbed
