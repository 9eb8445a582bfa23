#include "src/planning/fillet/fillet_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed::fillet {
namespace {

/// Step of the simulation of steering ramps [m]. The integration method is of fourth order; with a
/// step of 0.1 m, the heading error is 1e-9 rad.
constexpr double kStep = 0.1;

/// Heading change in a window below which the change counts as zero [rad].
constexpr double kNoHeading = 1e-9;

/// Driven distance and heading change of a turn in the first simulated run.
struct Window {
  double distance;
  double heading;
};

/// Simulates the car with its limited steering rate on a plan at `speed`. Returns the yaw of the
/// car at the steering events D_1, D_2, … [rad].
std::vector<double> YawsAtEvents(const VehicleParams& vehicle, const FilletPlan& plan, double speed,
                                 ReferencePoint reference) {
  // If the first ramp begins before the start of the path, start the car earlier.
  const double lead = plan.turns.empty() ? 0.0 : std::max(0.0, -plan.turns.front().steer_start);
  std::vector<FilletTurn> turns = plan.turns;
  std::vector<double> distances;
  for (FilletTurn& turn : turns) {
    turn.speed = speed;
    turn.steer_start += lead;
    turn.steer_return += lead;
    distances.push_back(turn.steer_start);
    distances.push_back(turn.steer_return);
  }
  const SteeringSchedule schedule = MakeSchedule(vehicle, turns);
  // Sort the steering events, because the steering of a turn may begin before the previous turn
  // ends.
  std::vector<double> rising = distances;
  std::sort(rising.begin(), rising.end());
  const KinematicState start{.pose = {0.0, 0.0, 0.0}, .speed = speed, .steering = schedule.At(0.0)};
  const auto states = RollOut(vehicle, start, schedule, rising, kStep, reference);
  std::vector<double> yaws;
  for (const double distance : distances) {
    const auto at = std::lower_bound(rising.begin(), rising.end(), distance) - rising.begin();
    yaws.push_back(states[static_cast<std::size_t>(at)].pose.yaw);
  }
  return yaws;
}

/// Simulates the first run and returns the driven distance and heading change of each turn.
std::vector<Window> FirstDrive(const VehicleParams& vehicle, const Route& route, double speed,
                               const FilletOptions& options, std::vector<FilletTurn> turns) {
  for (FilletTurn& turn : turns) {
    turn.speed = speed;
  }
  const FilletPlan plan = LayOut(vehicle, route, std::move(turns));
  const std::vector<double> yaws = YawsAtEvents(vehicle, plan, speed, options.reference);
  std::vector<Window> windows;
  for (std::size_t k = 0; k < plan.turns.size(); ++k) {
    const double end = plan.turns[k].steer_return;
    double begin = plan.turns[k].steer_start;
    double yaw = yaws[2 * k];
    if (options.objective == RadiusObjective::kLiteral) {
      begin = k == 0 ? 0.0 : plan.turns[k - 1].steer_return;
      yaw = k == 0 ? 0.0 : yaws[2 * k - 1];
    }
    windows.push_back({end - begin, yaws[2 * k + 1] - yaw});
  }
  return windows;
}

TurnSearch SearchTurn(const VehicleParams& vehicle, double speed, const FilletOptions& options,
                      std::uint64_t seed, const Window& window, const RadiusLimits& limits,
                      const FilletTurn& turn) {
  const double l_g =
      options.reference == ReferencePoint::kCenterOfGravity ? vehicle.cg_to_rear : 0.0;
  TurnSearch search;
  search.first_radius = turn.radius;
  search.time = window.distance / speed;
  search.heading = window.heading;
  const double along = window.distance / std::abs(window.heading);
  search.free_radius = std::abs(window.heading) < kNoHeading
                           ? std::numeric_limits<double>::infinity()
                           : std::sqrt(std::max(0.0, along * along - l_g * l_g));
  const double sign = std::copysign(1.0, turn.heading_change);
  SearchProblem problem;
  problem.lower = {vehicle.min_turning_radius()};
  problem.upper = {std::max(problem.lower[0], options.max_radius)};
  // Choose an initial radius inside the bounds for local search methods. The radius of the first
  // run lies on a bound, where an initial simplex would be degenerate.
  problem.start = {0.5 * (limits.radii.low + limits.radii.high)};
  problem.objective = [&](std::span<const double> r) {
    const double yaw_rate = sign * speed / std::hypot(r[0], l_g);  // C.25
    const double miss = yaw_rate * search.time - search.heading;
    return miss * miss;
  };
  problem.constraint_count = 1;
  problem.constraints = [&](std::span<const double> r, std::span<double> values) {
    values[0] = ConstraintAt(vehicle, limits.constraint, turn, r[0]);
  };
  search.result = Search(problem, options.search, seed);
  if (!search.result.ok()) {
    // The interval of feasible radii is too narrow for a search with constraints. Search between
    // the interval's known ends, without the constraint of feasible radii.
    problem.lower = {limits.radii.low};
    problem.upper = {limits.radii.high};
    search.result = Search(problem, options.search, seed);
  }
  return search;
}

}  // namespace

void SearchTurns(const VehicleParams& vehicle, const Route& route, double speed,
                 const FilletOptions& options, std::uint64_t seed,
                 const std::vector<RadiusLimits>& limits, std::vector<FilletTurn>& turns) {
  for (FilletTurn& turn : turns) {
    turn.radius = vehicle.min_turning_radius();
  }
  std::vector<Window> windows = FirstDrive(vehicle, route, speed, options, turns);
  for (std::size_t k = 0; k < turns.size(); ++k) {
    if (options.resimulate_each_turn && k > 0) {
      windows = FirstDrive(vehicle, route, speed, options, turns);
    }
    FilletTurn& turn = turns[k];
    if (turn.speed < speed) {
      // The speed of the turn was lowered so far that only a single radius is permitted.
      turn.radius = limits[k].radii.high;
      continue;
    }
    TurnSearch search = SearchTurn(vehicle, speed, options, seed, windows[k], limits[k], turn);
    if (!search.result.ok()) {
      throw Refusal{PlanStatus::kSearchFailed, turn.waypoint,
                    fmt::format("turn at waypoint {}: {} found no radius in {} evaluations ({})",
                                turn.waypoint, SearchFor(options.search.method).name,
                                search.result.evaluations, ToString(search.result.status))};
    }
    turn.radius = search.result.x[0];
    turn.search = std::move(search);
  }
}

}  // namespace trackbed::fillet
