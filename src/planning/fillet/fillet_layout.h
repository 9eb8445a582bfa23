#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/fillet/fillet.h"

/// Layout of a fillet plan with known radii, and the limits of the radii. The functions in this
/// file are the steps of PlanFillets, in order.
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
};

Route MakeRoute(const std::vector<Vec2>& waypoints);

/// The corners of the route: waypoint, angles and shorter leg of every turn.
std::vector<FilletTurn> FindTurns(const Route& route);

/// Limits of a turn's radius, and the constraint that is active at either end of the interval.
struct RadiusLimits {
  RadiusInterval radii;
  ActiveConstraint at_low;
  ActiveConstraint at_high;
  RadiusConstraint constraint;  ///< constraint that the turn satisfies
};

/// Sets the speed of a turn and the limits of its radius. If the turn's speed is not `speed`, sets
/// the reason for the turn's speed.
RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn);

/// The constraint that is active at a radius, with a relative tolerance of 1e-3. Returns kNone if
/// the radius lies inside the limits.
ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius);

/// The function g(r) [m] of equation C.34 or C.40, which has the form g(r) <= 0.
double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius);

/// Arcs, path and steering of turns with known radii and speeds. The ramps are centered on the
/// tangent points. Leaves out the steering schedule, because its order is checked last.
FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns);

/// The steering schedule of a plan's turns. Throws Refusal if the turns are out of order.
SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns);

/// Runs the two-pass search (kLiteral, kTurnLocal) over all turns. Fills in radii and findings.
void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns);

/// Number of variables of a turn in the joint search. The variables are the radius [m], the shift
/// of D_{2k-1} and the shift of the hold length D_2k - D_{2k-1}. The shifts are fractions of the
/// ramp distance.
inline constexpr std::size_t kDrivenVariables = 3;

/// Runs the joint search (kDriven), starting at a plan with the largest radii.
FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start);

}  // namespace trackbed::fillet
