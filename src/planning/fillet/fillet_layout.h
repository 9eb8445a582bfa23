#pragma once

#include <string>
#include <vector>

#include "trackbed/planning/fillet/fillet.h"

/// The first and the last step of PlanFillets: find the turns, and lay out path and steering
/// schedule. Between these two steps, fillet_radius.h limits the radii, and fillet_search.h and
/// fillet_driven.h choose the radii.
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

/// Returns the turns of the route, each with waypoint, angles and the length of the shorter
/// adjacent leg.
std::vector<FilletTurn> FindTurns(const Route& route);

/// Lays out the arcs, the path and the steering ramps of turns with known radii and speeds. The
/// ramps are centered on the tangent points. LayOut does not make the steering schedule, because
/// MakeSchedule throws if ramps overlap.
FilletPlan LayOut(const VehicleParams& vehicle, const Route& route, std::vector<FilletTurn> turns);

/// Makes the steering schedule of a plan's turns. Throws Refusal if the steering ramps of two turns
/// overlap or if a ramp begins before the start of the path.
SteeringSchedule MakeSchedule(const VehicleParams& vehicle, const std::vector<FilletTurn>& turns);

}  // namespace trackbed::fillet
