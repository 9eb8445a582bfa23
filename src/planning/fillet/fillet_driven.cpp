#include "src/planning/fillet/fillet_driven.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/planning/common/route_start.h"

namespace trackbed::fillet {
namespace {

/// Step of the simulation, and distance between the stations at which the simulated car is compared
/// with its path [m]. Steering ramps are meters long, so the step kSpacing causes a relative error
/// of the integrals of about a thousandth.
constexpr double kSpacing = 0.5;

class DrivenProblem {
 public:
  DrivenProblem(const VehicleParams& vehicle, const Route& route, const FilletOptions& options,
                const std::vector<RadiusLimits>& limits, const FilletPlan& start)
      : vehicle_(vehicle), route_(route), options_(options), limits_(limits), start_(start) {
    for (const FilletTurn& turn : start.turns) {
      ramps_ += turn.ramp_distance;
    }
  }

  /// Makes the fillet plan for the search variables x. Throws Refusal if the steering ramps of two
  /// turns overlap or if a ramp begins before the start of the path.
  [[nodiscard]] FilletPlan PlanAt(std::span<const double> x) const {
    std::vector<FilletTurn> turns = start_.turns;
    for (std::size_t k = 0; k < turns.size(); ++k) {
      turns[k].radius = x[kDrivenVariables * k];
    }
    FilletPlan plan = LayOut(vehicle_, route_, std::move(turns));
    for (std::size_t k = 0; k < plan.turns.size(); ++k) {
      FilletTurn& turn = plan.turns[k];
      turn.steer_start += x[kDrivenVariables * k + 1] * turn.ramp_distance;
      const double hold = turn.arc_length + x[kDrivenVariables * k + 2] * turn.ramp_distance;
      turn.steer_return = turn.steer_start + hold;
      turn.ramp_truncated = hold < turn.ramp_distance;
      if (hold <= 0.0) {
        throw Refusal{PlanStatus::kTurnsOverlap, turn.waypoint, "no hold"};
      }
    }
    plan.stop_distance = plan.path.length() + x.back() * ramps_;
    plan.schedule = MakeSchedule(vehicle_, plan.turns);
    return plan;
  }

  /// Returns the cost J of a plan that a simulated car drives in open loop.
  [[nodiscard]] double Cost(const FilletPlan& plan) const {
    const double end = plan.stop_distance;
    const auto intervals = static_cast<std::size_t>(std::ceil(end / kSpacing));
    const double spacing = end / static_cast<double>(intervals);
    std::vector<double> stations(intervals + 1);
    for (std::size_t i = 0; i <= intervals; ++i) {
      stations[i] = static_cast<double>(i) * spacing;
    }
    const KinematicState start{.pose = StartOfRoute(route_.waypoints),
                               // The simulated path is the same for every speed, because the
                               // steering schedule is a function of the distance.
                               .speed = 1.0};
    const auto states =
        RollOut(vehicle_, start, plan.schedule, stations, kSpacing, options_.reference);
    double position = 0.0;
    double heading = 0.0;
    for (std::size_t i = 0; i <= intervals; ++i) {
      const Pose2 planned = plan.path.At(stations[i]).pose;
      const double weight = i == 0 || i == intervals ? 0.5 * spacing : spacing;
      const double e_psi = states[i].pose.yaw - planned.yaw;
      position += weight * (states[i].pose.position() - planned.position()).squaredNorm();
      heading += weight * e_psi * e_psi;
    }
    const double miss = (states.back().pose.position() - route_.waypoints.back()).squaredNorm();
    const DrivenWeights& w = options_.weights;
    return w.position * position + w.heading * heading + w.end * miss;
  }

  [[nodiscard]] SearchProblem Problem() const {
    SearchProblem problem;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const RadiusInterval& radii = limits_[k].radii;
      problem.lower.insert(problem.lower.end(), {radii.low, -0.5, -0.5});
      problem.upper.insert(problem.upper.end(), {radii.high, 0.5, 0.5});
      problem.start.insert(problem.start.end(), {start_.turns[k].radius, 0.0, 0.0});
    }
    // Due to the steering ramps, the driven path is longer or shorter than the plan's path by a
    // fraction of the ramps' length.
    problem.lower.push_back(-0.25);
    problem.upper.push_back(0.25);
    problem.start.push_back(0.0);
    problem.objective = [this](std::span<const double> x) {
      try {
        return Cost(PlanAt(x));
      } catch (const Refusal&) {
        return std::numeric_limits<double>::quiet_NaN();
      }
    };
    return problem;
  }

 private:
  const VehicleParams& vehicle_;
  const Route& route_;
  const FilletOptions& options_;
  const std::vector<RadiusLimits>& limits_;
  const FilletPlan& start_;
  double ramps_ = 0.0;  // Sum of the ramp lengths of all turns [m].
};

}  // namespace

FilletPlan SearchDriven(const VehicleParams& vehicle, const Route& route,
                        const FilletOptions& options, std::uint64_t seed,
                        const std::vector<RadiusLimits>& limits, const FilletPlan& start) {
  const DrivenProblem driven(vehicle, route, options, limits, start);
  SearchProblem problem = driven.Problem();
  SearchOptions global = options.search;
  global.population = std::max(global.population, static_cast<int>(problem.lower.size()) + 2);
  SearchResult result = Search(problem, global, seed);
  if (!result.ok()) {
    throw Refusal{PlanStatus::kSearchFailed, -1,
                  fmt::format("{} found no feasible plan in {} evaluations ({})",
                              SearchFor(options.search.method).name, result.evaluations,
                              ToString(result.status))};
  }
  // The global search ends in a narrow valley of the cost function; a gradient method then finds
  // the minimum in this valley.
  problem.start = result.x;
  SearchOptions polish = global;
  polish.method = SearchMethod::kSlsqp;
  polish.evaluations = 0;
  SearchResult polished = Search(problem, polish, seed);
  for (SearchProgress& progress : polished.history) {
    progress.evaluations += result.evaluations;
    result.history.push_back(std::move(progress));
  }
  result.evaluations += polished.evaluations;
  if (polished.ok() && polished.value < result.value) {
    result.x = polished.x;
    result.value = polished.value;
  }
  FilletPlan plan = driven.PlanAt(result.x);
  plan.search = std::move(result);
  return plan;
}

}  // namespace trackbed::fillet
