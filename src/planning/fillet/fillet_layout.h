#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/fillet/fillet.h"

/// The geometry of a fillet plan whose radii are known, and the limits within which they are
/// chosen. Steps of PlanFillets, in the order in which it takes them.
namespace trackbed::fillet {

/// Thrown to leave the planning of a route at its first obstacle; PlanFillets makes it a status.
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
};

Route MakeRoute(const std::vector<Vec2>& waypoints);

/// The route's corners: waypoint, angles and shorter leg of every turn.
std::vector<FilletTurn> FindTurns(const Route& route);

/// Within what a turn's radius is chosen, and what lies at either end.
struct RadiusLimits {
  RadiusInterval radii;
  ActiveConstraint at_low;
  ActiveConstraint at_high;
  RadiusConstraint constraint;  ///< the one that the turn keeps
};

/// Decides the speed of a turn (and says why, if it is not `speed`) and the limits of its radius.
RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn);

/// What holds a radius within its limits: an end that it reaches to a thousandth, or nothing.
ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius);

/// C.34 or C.40 as g(r) <= 0 [m].
double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius);

/// The plan of turns whose radii and speeds are known: arcs, path, and steering centered on the
/// tangent points. Without the schedule, whose order is checked last.
FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns);

/// The schedule of a plan's turns as they stand. Refusal when they are out of order.
SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns);

/// Runs the two-pass search (kLiteral, kTurnLocal) over all turns; fills in radii and findings.
void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns);

/// Variables of a turn in the joint search, in this order: radius [m], and the shifts of D_{2k-1}
/// and of the hold length D_2k - D_{2k-1} from their nominal values, as shares of the ramp
/// distance.
inline constexpr std::size_t kDrivenVariables = 3;

/// Runs the joint search (kDriven) from a plan with the largest radii.
FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start);

}  // namespace trackbed::fillet
