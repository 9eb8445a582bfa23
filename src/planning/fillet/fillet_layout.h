#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/fillet/fillet.h"

/// Functions for the steps of PlanFillets, in the order of use: find the turns, limit the radii,
/// choose the radii, lay out path and steering schedule.
namespace trackbed::fillet {

/// Thrown at the first failure of a fillet plan; PlanFillets turns the exception into a status.
struct Refusal {
  PlanStatus status;
  int waypoint;
  std::string reason;
};

struct Leg {
  double length;
  Vec2 direction;
};

struct Route {
  std::vector<Vec2> waypoints;
  std::vector<Leg> legs;
  std::vector<int> numbers;  ///< index in the mission of each of `waypoints`
};

Route MakeRoute(const std::vector<Vec2>& waypoints);

/// Returns the least part of a leg that eq. (C.40) reserves for a turn at `speed`, over all radii
/// within `bounds` [m]. The wheels are straight between turns.
double LeastSteeringRoom(const VehicleParams& vehicle, double speed, double interior_angle,
                         RadiusInterval bounds);

/// Leaves out waypoints if a turn has no room on its legs, but the remaining turns have. The
/// remaining legs must pass each waypoint within a quarter of the car's width and
/// FilletOptions::max_waypoint_miss. Otherwise, returns the route itself. Start, goal and the
/// direction of the first leg stay the same.
Route WithoutCloseWaypoints(const VehicleParams& vehicle, const Route& route, double speed,
                            const FilletOptions& options);

/// Whether a route by WithoutCloseWaypoints leaves out the waypoint `i` of the mission.
bool IsLeftOut(const Route& route, const std::vector<Vec2>& waypoints, int i);

/// Returns the turns of the route, each with waypoint, angles and the length of the shorter
/// adjacent leg.
std::vector<FilletTurn> FindTurns(const Route& route);

/// Interval of the permitted radii of a turn, and the constraints that determine the ends of this
/// interval.
struct RadiusLimits {
  RadiusInterval radii;
  ActiveConstraint at_low;
  ActiveConstraint at_high;
  RadiusConstraint constraint;  ///< kind of the constraint that limits the turn's radius
};

/// Sets the speed of a turn and returns the limits of its radius. If the speed of the turn is below
/// `speed`, also stores a note with the reason.
RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn);

/// Returns the constraint that limits the radius if the radius lies on a limit (relative tolerance
/// 1e-3), or kNone if the radius lies inside the limits.
ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius);

/// Returns the function g(r) [m] of the constraint g(r) <= 0, which is equation C.34 or C.40.
double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius);

/// Lays out the arcs, the path and the steering ramps of turns with known radii and speeds. The
/// ramps are centered on the tangent points. The steering schedule is not made here but by
/// MakeSchedule, because MakeSchedule throws if ramps overlap.
FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns);

/// Makes the steering schedule of a plan's turns. Throws Refusal if the steering ramps of two turns
/// overlap or if a ramp begins before the start of the path.
SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns);

/// Optimizes the radii of all turns in two passes, for the objectives kLiteral and kTurnLocal.
/// Stores the radii and the results of the search in the plan.
void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns);

/// Number of variables per turn in the joint search. The variables of turn k are the radius [m],
/// the shift of the start of steering D_{2k-1}, and the change of the hold length D_2k - D_{2k-1}.
/// The shift and the change of the hold length are expressed as fractions of the ramp length.
inline constexpr std::size_t kDrivenVariables = 3;

/// Optimizes all variables of all turns jointly for the objective kDriven, starting at a plan with
/// the largest radii.
FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start);

}  // namespace trackbed::fillet
