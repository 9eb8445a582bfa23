#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "src/planning/curves/continuous_route.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/lead_in.h"

/// The cheapest leg of continuous curvature between two stops.
namespace trackbed {

/// Both ends of a leg, and the place of the leg in its route.
struct LegEnds {
  CurveState from;
  CurveState to;
  bool is_first = false;  ///< Whether the leg begins at the start of the route.
  bool is_last = false;   ///< Whether the leg ends at the goal.
};

/// A leg between two stops.
struct ContinuousLeg {
  std::vector<Segment> segments;
  ShortestCurve word;
  CurveFindings findings;
  double speed = 0.0;  ///< Speed on the turns [m/s].
  std::size_t lead =
      0;  ///< Number of segments before the turns, on which a rolling car slows down.
  double cost = kNoCurve;  ///< Driving time [s] or length with penalties [m]; infinite: no leg.
};

/// Finds the cheapest leg between two stops that is free of obstacles.
class LegFinder {
 public:
  /// Keeps references to the route and the request.
  LegFinder(const ContinuousRoute& route, const PlanRequest& request);

  /// Returns the choices of speeds for a leg [m/s], from the mission's speed to the lowest speed.
  /// On a leg without room for turns at the lowest speed, the car crawls instead of turning its
  /// wheels at rest.
  [[nodiscard]] std::vector<double> Speeds() const;

  /// Returns the largest curvature at `speed` [1/m].
  [[nodiscard]] double MaxCurvature(double speed) const;

  /// Returns whether the car rolls at the start of the leg.
  [[nodiscard]] bool IsRolling(const LegEnds& ends) const {
    return ends.is_first && request_.start_speed > 0.0;
  }

  /// Returns the cheapest leg at one of the choices of speeds, or, with several choices, at two
  /// speeds. The cost of the leg is infinite if all legs are blocked, or cost more than `bound`.
  [[nodiscard]] ContinuousLeg Cheapest(const LegEnds& ends, const std::vector<double>& speeds,
                                       double bound);

  /// Returns the largest number of curves tried for one leg at one speed.
  [[nodiscard]] std::size_t tried() const { return tried_; }

  /// Returns whether the car keeps its safe distance from all obstacles at the pose.
  [[nodiscard]] bool IsFree(const Pose2& pose) const { return clear_.IsFree(pose); }

 private:
  class Choice;
  struct LegStart;

  [[nodiscard]] CurveLimits LimitsAt(double speed, double start_curvature) const;
  [[nodiscard]] CurveMotion MotionFrom(const CurveState& start, const LegEnds& ends) const;
  [[nodiscard]] std::vector<ShortestCurve> Words(const CurveLimits& limits, const LegEnds& ends,
                                                 const CurveState& start, double longest) const;
  [[nodiscard]] double CostOf(const std::vector<Segment>& segments, double speed,
                              const LegEnds& ends) const;
  [[nodiscard]] double LeastCost(const std::vector<Segment>& segments, double speed) const;
  [[nodiscard]] double LongestWithin(double bound, double speed, const LegEnds& ends) const;
  [[nodiscard]] std::vector<LegStart> StartsAt(double speed, const LegEnds& ends) const;
  [[nodiscard]] double LeadCost(const LegStart& start) const;
  void AddLegsAt(double speed, const LegEnds& ends, Choice& choice) const;
  void AddLegsOfTwoSpeeds(const std::vector<double>& speeds, const LegEnds& ends,
                          Choice& choice) const;

  const ContinuousRoute& route_;
  const PlanRequest& request_;
  CollisionChecker clear_;
  LegLimits limits_;
  double speed_;
  std::size_t tried_ = 0;
};

}  // namespace trackbed
