#include "trackbed/planning/fillet/fillet_planner.h"

#include <fmt/format.h>

#include <cmath>

#include "src/planning/fillet/fillet_driven.h"
#include "src/planning/fillet/fillet_layout.h"
#include "src/planning/fillet/fillet_waypoints.h"
#include "trackbed/planning/common/waypoint_miss.h"

// Converts a fillet plan (Skackauskas, dissertation, appendix C and listing F.1) to a Plan. The
// Plan contains the path, its steering schedule, and speed caps over the turns that are slower than
// the mission's speed. The Plan also lists isolated turns, whose heading error can be predicted.
// The rest of this file writes the diagnostics to plan.json.

namespace trackbed {
namespace {

/// Data for the part of plan.json about a search and its progress. The function `radii` extracts
/// the radii from the variables of the search.
struct SearchRecord {
  const std::string& method;
  const SearchResult& result;
  std::vector<double> (*radii)(const std::vector<double>& x);
};

struct ProgressRecord {
  int evaluations = 0;
  double value = 0.0;
  std::vector<double> radii;  ///< Radii of the turns at this step of the search [m].
};

void Visit(DiagnosticsVisitor& out, const ProgressRecord& own) {
  out.Integer("evaluations", own.evaluations);
  out.Number("objective", own.value);
  out.Numbers("radius_m", own.radii);
}

void Visit(DiagnosticsVisitor& out, const SearchRecord& own) {
  if (out.full()) {
    out.Text("method", own.method);
    out.Text("status", ToString(own.result.status));
  }
  out.Integer("evaluations", own.result.evaluations);
  out.Number("objective", own.result.value);
  if (out.full()) {
    std::vector<ProgressRecord> history;
    for (const SearchProgress& progress : own.result.history) {
      history.push_back({progress.evaluations, progress.value, own.radii(progress.x)});
    }
    out.List("history", history);
  }
}

/// Data for the part of plan.json about the search for the radius of a single turn.
struct TurnSearchRecord {
  const std::string& method;
  const TurnSearch& search;
};

void Visit(DiagnosticsVisitor& out, const TurnSearchRecord& own) {
  out.Number("first_radius_m", own.search.first_radius);
  Visit(out, SearchRecord{own.method, own.search.result,
                          [](const std::vector<double>& x) { return x; }});
  if (out.full()) {
    out.Number("window_time_s", own.search.time);
    out.Number("window_heading_rad", own.search.heading);
    out.Number("free_radius_m", own.search.free_radius);
  }
}

struct PredictedRecord {
  const TurnError& error;
};

void Visit(DiagnosticsVisitor& out, const PredictedRecord& own) {
  out.Number("heading_deficit_rad", own.error.heading_deficit);
  if (out.full()) {
    out.Number("lateral_offset_m", own.error.lateral_offset);
  }
}

/// Returns the station at which the wheels are straight again after a turn.
double ReturnEnd(const FilletTurn& turn) {
  return turn.steer_return + turn.ramp_distance;
}

std::vector<IsolatedTurn> FindIsolatedTurns(const FilletPlan& plan) {
  std::vector<IsolatedTurn> lone;
  double straight_from = 0.0;
  for (const FilletTurn& turn : plan.turns) {
    const bool alone = turn.steer_start >= straight_from && turn.neutral == 0.0;
    straight_from = ReturnEnd(turn);
    const double middle = turn.arc_start_s + 0.5 * turn.arc_length;
    if (alone && !turn.ramp_truncated && turn.steer_start + turn.ramp_distance <= middle) {
      lone.push_back({turn.waypoint, turn.steer_start, middle, turn.steering, turn.speed});
    }
  }
  return lone;
}

/// Returns the speed caps of turns slower than `speed`. Each speed cap extends from the start of
/// the first steering ramp of a turn to the end of the second.
std::vector<SpeedCap> MakeSpeedCaps(const FilletPlan& plan, double speed) {
  std::vector<SpeedCap> caps;
  for (const FilletTurn& turn : plan.turns) {
    if (turn.speed < speed) {
      caps.push_back({turn.steer_start, ReturnEnd(turn), turn.speed});
    }
  }
  return caps;
}

/// Says how close the path passes the waypoints that it leaves out.
std::string DescribeLeftOut(const FilletPlan& plan, const std::vector<Vec2>& waypoints) {
  std::vector<Vec2> left_out{waypoints.front()};
  for (const int i : plan.left_out) {
    left_out.push_back(waypoints[static_cast<std::size_t>(i)]);
  }
  const auto miss = LargestWaypointMiss(plan.path, left_out);
  return fmt::format(
      "{} waypoint{} without room for turns {} left out; the path passes {} at {:.3g} m",
      plan.left_out.size(), plan.left_out.size() == 1 ? "" : "s",
      plan.left_out.size() == 1 ? "is" : "are",
      DescribeWaypoint(static_cast<std::size_t>(plan.left_out[miss->waypoint - 1]), miss->at),
      miss->distance);
}

Plan PlanWith(const FilletOptions& given, const PlanRequest& request) {
  FilletOptions options = given;
  options.max_waypoint_miss = request.max_waypoint_miss.value_or(given.max_waypoint_miss);
  const FilletPlan fillets =
      PlanFillets(request.vehicle, request.waypoints, request.speed.speed, options, request.seed);
  Plan plan;
  plan.status = fillets.status;
  plan.reason = fillets.reason;
  if (plan.status == PlanStatus::kWaypointMissed) {
    const auto waypoint = static_cast<std::size_t>(fillets.waypoint);
    plan.reason = DescribeWaypoint(waypoint, request.waypoints[waypoint]) + " is " + plan.reason;
  }
  if (!plan.ok()) {
    plan.diagnostics.planner = FilletDiagnostics{.failed_waypoint = fillets.waypoint};
    return plan;
  }
  if (!fillets.left_out.empty()) {
    plan.notes.push_back(DescribeLeftOut(fillets, request.waypoints));
  }
  plan.reference.path = fillets.path;
  plan.schedule = fillets.schedule;
  plan.turns = FindIsolatedTurns(fillets);
  plan.caps = MakeSpeedCaps(fillets, request.speed.speed);
  plan.goal = fillets.path.At(fillets.path.length()).pose;
  plan.reference.speed =
      StopAtEnd(fillets.path.length(), request.start_speed, request.speed, plan.caps);
  plan.schedule_speed =
      StopAtEnd(fillets.stop_distance, request.start_speed, request.speed, plan.caps);

  FilletDiagnostics own{
      .neutral_steering = options.neutral_steering,
      .neutral_curvature = CurvatureForSteering(request.vehicle, options.neutral_steering),
      .search_method = SearchFor(options.search.method).name,
      .search = fillets.search};
  for (const FilletTurn& turn : fillets.turns) {
    FilletTurnFindings found{.turn = turn, .search_method = own.search_method};
    for (const IsolatedTurn& alone : plan.turns) {
      if (alone.waypoint == turn.waypoint) {
        found.predicted = PredictTurn(request.vehicle, fillets.path, alone, 0.0);
      }
    }
    plan.diagnostics.turns.emplace_back(std::move(found));
  }
  plan.diagnostics.planner = std::move(own);
  plan.diagnostics.stop_distance = fillets.stop_distance;
  plan.diagnostics.open_loop = fillets.verification;
  return plan;
}

std::vector<OptionProblem> CheckConstraint(const FilletOptions& options,
                                           const CouldReadKey& could_read) {
  if (!could_read("radius") || !could_read("constraint") || options.radius ||
      options.constraint != RadiusConstraint::kNone) {
    return {};
  }
  return {{"constraint", "'none' requires plan.radius"}};
}

double NeutralSteering(const FilletOptions& options) {
  return options.neutral_steering;
}

/// Returns a table with the convergence history of each search: the best radii after each
/// generation.
Table ConvergenceTable(const PlanDiagnostics& diagnostics) {
  Table table({"waypoint", "evaluations", "objective", "radius_m"});
  const auto* all_turns = diagnostics.planner.GetIf<FilletDiagnostics>();
  for (std::size_t k = 0; k < diagnostics.turns.size(); ++k) {
    const auto& found = diagnostics.turns[k].Get<FilletTurnFindings>();
    const double waypoint = found.turn.waypoint;
    if (found.turn.search) {
      for (const SearchProgress& best : found.turn.search->result.history) {
        table.AddRow({waypoint, static_cast<double>(best.evaluations), best.value, best.x[0]});
      }
    } else if (all_turns != nullptr && all_turns->search) {
      for (const SearchProgress& best : all_turns->search->history) {
        table.AddRow(
            {waypoint, static_cast<double>(best.evaluations), best.value, DrivenRadii(best.x)[k]});
      }
    }
  }
  return table;
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const FilletTurnFindings& own) {
  const FilletTurn& turn = own.turn;
  out.Integer("waypoint", turn.waypoint);
  out.Number("heading_change_rad", turn.heading_change);
  out.Number("radius_m", turn.radius);
  out.Number("speed_mps", turn.speed);
  out.Text("active_constraint", ToString(turn.active));
  out.Number("ramp_time_s", turn.ramp_time);
  out.Number("ramp_distance_m", turn.ramp_distance);
  out.Number("steer_start_m", turn.steer_start);
  out.Number("steer_return_m", turn.steer_return);
  out.Flag("ramp_truncated", turn.ramp_truncated);
  if (!turn.note.empty()) {
    out.Text("note", turn.note);
  }
  if (turn.search) {
    out.Section("search", TurnSearchRecord{own.search_method, *turn.search});
  }
  if (own.predicted) {
    out.Section("predicted", PredictedRecord{*own.predicted});
  }
  if (out.full()) {
    out.Number("interior_angle_rad", turn.interior_angle);
    out.Point("center_m", turn.center);
    out.Point("arc_start_m", turn.arc_start);
    out.Point("arc_end_m", turn.arc_end);
    out.Number("arc_start_s_m", turn.arc_start_s);
    out.Number("arc_length_m", turn.arc_length);
    out.Number("tangent_length_m", turn.tangent_length);
    out.Number("steering_rad", turn.steering);
  }
}

void ReplaceStretch(FilletTurnFindings& own, const Stations& replaced, double shift) {
  FilletTurn& turn = own.turn;
  if (turn.steer_start >= replaced.to) {
    for (double* station : {&turn.arc_start_s, &turn.steer_start, &turn.steer_return}) {
      *station += shift;
    }
  } else if (turn.steer_return > replaced.from) {
    turn.note = "rerouted around an obstacle here";
  }
}

void Visit(DiagnosticsVisitor& out, const FilletDiagnostics& own) {
  if (own.failed_waypoint) {
    out.Integer("waypoint", *own.failed_waypoint);
  }
  if (own.neutral_steering != 0.0) {
    out.Number("neutral_steering_rad", own.neutral_steering);
    out.Number("neutral_curvature_radpm", own.neutral_curvature);
  }
  if (own.search) {
    out.Section("search", SearchRecord{own.search_method, *own.search, DrivenRadii});
  }
}

std::vector<double> DrivenRadii(const std::vector<double>& x) {
  std::vector<double> radii;
  for (std::size_t i = 0; i + fillet::kDrivenVariables <= x.size(); i += fillet::kDrivenVariables) {
    radii.push_back(x[i]);
  }
  return radii;
}

PlannerEntry FilletPlanner() {
  return {.name = "fillet",
          .summary =
              "straight legs joined by arcs of the largest radius that the steering rate allows "
              "(Skackauskas, dissertation)",
          .defaults = FilletOptions{},
          .plan = PlanBy<FilletOptions, PlanWith>,
          .min_waypoints = kMinFilletWaypoints,
          .check = OnOptions<FilletOptions, CheckConstraint>,
          .neutral_steering = OnOptions<FilletOptions, NeutralSteering>,
          .tables = {{"convergence.csv", ConvergenceTable}}};
}

}  // namespace trackbed
