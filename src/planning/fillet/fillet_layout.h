#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/fillet/fillet.h"

/// Steps of PlanFillets, in order: find the turns, limit and choose their radii, lay out path and
/// steering schedule.
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

/// Returns the turns of the route, each with its waypoint, its angles and the length of its shorter
/// leg.
std::vector<FilletTurn> FindTurns(const Route& route);

/// Limits of a turn's radius, and the constraints that are active at both ends of the interval of
/// radii.
struct RadiusLimits {
  RadiusInterval radii;
  ActiveConstraint at_low;
  ActiveConstraint at_high;
  RadiusConstraint constraint;  ///< constraint that limits the turn's radius
};

/// Sets the speed of a turn and returns the limits of its radius. If the turn is slower than
/// `speed`, also sets the note with the reason.
RadiusLimits LimitRadius(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                         FilletTurn& turn);

/// Returns the constraint that is active at a radius, with a relative tolerance of 1e-3. Returns
/// kNone if the radius lies inside the limits.
ActiveConstraint ActiveAt(const RadiusLimits& limits, double radius);

/// Returns the function g(r) [m] of the constraint g(r) <= 0, which is equation C.34 or C.40.
double ConstraintAt(const VehicleParams& vehicle, RadiusConstraint constraint,
                    const FilletTurn& turn, double radius);

/// Lays out the arcs, the path and the steering ramps of turns with known radii and speeds. The
/// ramps are centered on the tangent points. MakeSchedule adds the steering schedule later, because
/// it throws if ramps overlap.
FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns);

/// Makes the steering schedule of a plan's turns. Throws Refusal if the turns overlap or steer
/// before the start.
SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns);

/// Searches the radii of all turns in two passes (objectives kLiteral and kTurnLocal). Sets the
/// radii and the findings of the search.
void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns);

/// Number of variables of a turn in the joint search. The variables of turn k are the radius [m],
/// the shift of the start of steering D_{2k-1}, and the change of the hold length D_2k - D_{2k-1}.
/// Shift and change are fractions of the ramp length.
inline constexpr std::size_t kDrivenVariables = 3;

/// Searches all variables of all turns jointly (objective kDriven), starting at a plan with the
/// largest radii.
FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start);

}  // namespace trackbed::fillet
