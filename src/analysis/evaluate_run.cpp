#include "trackbed/analysis/evaluate_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "src/analysis/aid_metrics.h"
#include "src/analysis/clearance_remedy.h"
#include "src/analysis/origin_statement.h"
#include "src/analysis/overspeed.h"
#include "src/analysis/peaks.h"
#include "trackbed/analysis/record_metrics.h"
#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/control/controllers.h"
#include "trackbed/planning/replan/replan.h"
#include "trackbed/scenario/input_files.h"

namespace trackbed {
namespace {

/// Returns the fraction of the log rows in which at least one loaded tyre slides.
double SlidingShare(const RunLog& log) {
  constexpr double kSlip = 0.1;  // Slip ratio or slip angle above which a tyre slides.
  // Speed below which rounding errors dominate the computed slip [m/s].
  constexpr double kAtLeast = 1.0;
  const auto slides = [&](const LogRow& row) {
    return std::abs(row.state.speed) > kAtLeast && row.state.wheels &&
           std::any_of(
               row.state.wheels->begin(), row.state.wheels->end(), [&](const WheelState& wheel) {
                 return wheel.normal_force > 0.0 &&
                        (std::abs(wheel.slip_ratio) > kSlip || std::abs(wheel.slip_angle) > kSlip);
               });
  };
  return static_cast<double>(std::count_if(log.rows.begin(), log.rows.end(), slides)) /
         static_cast<double>(log.rows.size());
}

/// Adds a note to the verdict if tyres slid that were simulated by MuJoCo's contacts. MuJoCo's
/// friction cone lifts sliding contacts, so the wheel loads of a run with sliding contacts are not
/// realistic.
void NoteSlidingContacts(RunResult& result, const CarModel& car) {
  constexpr double kNotedFraction = 0.01;
  for (const RunLog& log : result.logs) {
    const bool contact = log.plant == "mujoco:contact" ||
                         (log.plant == "mujoco" &&
                          SelectTyreLaw(car, result.scenario.vehicle.tyre) == TyreLaw::kContact);
    const double share = contact ? SlidingShare(log) : 0.0;
    if (share > kNotedFraction) {
      result.verdict.notes.push_back(fmt::format(
          "{}: the tyres slid on MuJoCo contacts for {:.0f} % of the time and bounced; forces and "
          "accelerations are not realistic there (use vehicle.tyre: magic_formula)",
          log.plant, 100.0 * share));
    }
  }
}

/// Returns the time at which the plan after a change ends [s].
double EndOfChange(const RunLog& log, std::size_t change) {
  return change + 1 < log.changes.size() ? log.changes[change + 1].time
                                         : log.rows.back().state.time;
}

/// Adds a note to the verdict for each plant whose car followed a slower obstacle: for how long,
/// and the reason for not passing that held longest.
void NoteFollowing(RunResult& result) {
  for (const RunLog& log : result.logs) {
    // Time for which each reason for not passing a slower obstacle held [s].
    std::map<std::string, double> times;
    double total = 0.0;
    for (std::size_t i = 0; i < log.changes.size(); ++i) {
      const auto* found = log.changes[i].plan.diagnostics.replan.GetIf<ReplanDiagnostics>();
      if (found == nullptr || !found->along || found->along->kind != ManeuverType::kFollow) {
        continue;
      }
      const double time = EndOfChange(log, i) - log.changes[i].time;
      times[found->along->why] += time;
      total += time;
    }
    if (total > 0.0) {
      const auto longest =
          std::max_element(times.begin(), times.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      result.verdict.notes.push_back(
          fmt::format("{}: followed a slower obstacle for {:.3g} s instead of passing it: {}",
                      log.plant, total, longest->first));
    }
  }
}

/// A place where the car stood still, because its plan led no further.
struct Stand {
  double station = 0.0;  // [m]
  double time = 0.0;     // [s]
  std::string why;       // Why the first plan ended there.
};

/// Returns the places where the car stood still until a later plan led on.
std::vector<Stand> StandsOf(const RunLog& log) {
  constexpr double kAtRest = 1e-3;  // [m/s]
  std::vector<Stand> stands;
  Stand stand;
  std::size_t row = 1;
  for (std::size_t i = 0; i < log.changes.size(); ++i) {
    const std::string& blocked = log.changes[i].plan.blocked;
    if (blocked.empty() && stand.time > 0.0) {
      stands.push_back(std::exchange(stand, {}));
    }
    for (; row < log.rows.size() && log.rows[row].state.time <= EndOfChange(log, i); ++row) {
      const VehicleState& state = log.rows[row].state;
      if (blocked.empty() || state.time <= log.changes[i].time ||
          std::abs(state.speed) >= kAtRest) {
        continue;
      }
      if (stand.time == 0.0) {
        stand = {.station = RowStation(log.rows[row]), .why = blocked};
      }
      stand.time += state.time - log.rows[row - 1].state.time;
    }
  }
  return stands;
}

/// Adds a note to the verdict for each place where the car stood still until a later plan led on.
void NoteWaiting(RunResult& result) {
  for (const RunLog& log : result.logs) {
    for (const Stand& stand : StandsOf(log)) {
      result.verdict.notes.push_back(fmt::format("{}: stood for {:.3g} s at s = {:.4g} m: it {}",
                                                 log.plant, stand.time, stand.station, stand.why));
    }
  }
}

PlantMetrics MeasurePlant(const RunResult& result, const RunLog& log, const CarModel& car) {
  const Scenario& scenario = result.scenario;
  PlantMetrics metrics = Measure(log, result.plan, car.params(), scenario.drive.control_period,
                                 ControllerFor(scenario.control.steering).station);
  metrics.steering_is_prescribed = scenario.drive.steering == SteeringInput::kPrescribed;
  if (metrics.tracking) {
    metrics.tracking->overspeed_limit = OverspeedLimit(log, scenario, car.unladen());
  }
  if (log.plant == kRecordedPlant) {
    // Clear the steering limits, because the limits of the car model do not apply to the real
    // vehicle that was recorded.
    metrics.steering_rate_limit = 0.0;
    metrics.steering_limit = 0.0;
    metrics.steering_activity.reset();
    metrics.steering_saturated_fraction = 0.0;
  }
  if (car.params().kind == VehicleKind::kDifferential) {
    // A differential drive has no wheels that a motor steers. The steering angle of a differential
    // drive follows from the speeds of the wheels, so the steering angle jumps where the wheels
    // slip, for example on a slope.
    metrics.steering_rate_limit = 0.0;
  }
  if (scenario.maneuver) {
    metrics.maneuver = EvaluateManeuver(*scenario.maneuver, log, result.plan, car.params());
  }
  metrics.recovery = MeasureRecovery(log, scenario.disturb, scenario.world.wind);
  metrics.requirements = MeasureRequirements(scenario.expect, log);
  return metrics;
}

}  // namespace

void AddLog(RunResult& result, const CarModel& car, RunLog log, std::vector<WindowErrors> windows) {
  const Scenario& scenario = result.scenario;
  result.logs.push_back(std::move(log));
  result.logs.back().origin = OriginOf(scenario);
  const RunLog& added = result.logs.back();
  PlantMetrics& metrics = result.metrics.emplace_back(MeasurePlant(result, added, car));
  if (scenario.record && added.plant != kRecordedPlant) {
    metrics.recorded = MeasureAgainstRecord(added, *scenario.record->data, car.params(),
                                            scenario.record->min_speed);
    metrics.windows = std::move(windows);
  }
}

void JudgeRun(RunResult& result, const CarModel& car) {
  const Scenario& scenario = result.scenario;
  for (std::size_t i = 0; i < result.logs.size(); ++i) {
    for (std::size_t j = i + 1; j < result.logs.size(); ++j) {
      result.comparisons.push_back(ComparePlants(result.logs[i], result.logs[j]));
    }
  }
  result.verdict = Judge(scenario.expect, result.metrics, result.comparisons);
  for (const std::string& note : result.plan->notes) {
    result.verdict.notes.push_back("plan: " + note);
  }
  ProposeSafeDistance(result, car.params());
  NoteOrigin(result.scenario, result.verdict);
  if (const auto& rate = scenario.vehicle.steering_rate) {
    result.verdict.notes.push_back(fmt::format("steering rate set to {:.4g} rad/s", *rate));
  }
  for (std::string& note : TyreFileNotes(scenario)) {
    result.verdict.notes.push_back(std::move(note));
  }
  NoteSlidingContacts(result, car);
  NoteIgnoredAids(result.scenario, result.logs, result.verdict.notes);
  NoteFollowing(result);
  NoteWaiting(result);
  if (scenario.record) {
    for (const std::string& note : scenario.record->data->notes) {
      result.verdict.notes.push_back("record: " + note);
    }
  }
}

}  // namespace trackbed
