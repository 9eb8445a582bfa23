#include "src/cli/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

#include "src/cli/terminal.h"
#include "trackbed/report/names.h"

namespace trackbed::cli {
namespace {

void PrintManeuver(const ManeuverMetrics& maneuver) {
  Print("    {}{}{}, evaluated from {:.2f} s to {:.2f} s of the run\n", maneuver.method,
        maneuver.passed ? ": " : "",
        !maneuver.passed   ? SafeText{}
        : *maneuver.passed ? Colorize(Tone::kGood, "passed")
                           : Colorize(Tone::kBad, "FAILED"),
        maneuver.begin, maneuver.end);
  for (const auto& [path, value] : maneuver.values) {
    const ShownName name = NameOfMetric("maneuver." + path);
    constexpr std::string_view kGroup = "Maneuver: ";
    SafeText met;
    const std::string text =
        fmt::format("    {:<44} {:>10.4g}{}",
                    name.label.starts_with(kGroup) ? name.label.substr(kGroup.size()) : name.label,
                    value, name.unit.empty() ? "" : " " + name.unit);
    if (name.limit) {
      const bool at_most = name.limit->relation == StandardLimit::Relation::kAtMost;
      met = Colorize(
          name.limit->Met(value) ? Tone::kGood : Tone::kBad,
          fmt::format(" ({} {:.4g} to pass)", at_most ? "at most" : "at least", name.limit->bound));
    }
    Print("{}{}\n", text, met);
  }
  if (!maneuver.missing.empty()) {
    Print("    {}\n", maneuver.missing);
  }
}

/// Prints how far a plant deviates from the recorded drive.
void PrintRecord(const PlantMetrics& plant) {
  const RecordMetrics& recorded = *plant.recorded;
  Print(
      "    against the record: yaw rate {:.3g}, lateral acceleration {:.3g} (relative rms); "
      "position max {:.3g} m\n",
      recorded.yaw_rate_relative_rms, recorded.lateral_acceleration_relative_rms,
      recorded.position_max);
  for (const WindowErrors& windows : plant.windows) {
    Print("    after {:.3g} s, {} windows: ", windows.horizon, windows.count);
    if (windows.count > 0) {
      Print("position {:.3g} m, 90 % {:.3g} m; heading {:.3g} rad, 90 % {:.3g} rad\n",
            windows.position_median, windows.position_p90, windows.heading_median,
            windows.heading_p90);
    } else {
      Print("nothing to measure\n");
    }
  }
}

/// Formats the final status of a run in words, such as "rolled over".
std::string InWords(DriveStatus status) {
  std::string words = ToString(status);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// Prints the oscillation of the steering command if the command oscillates.
void PrintOscillation(const PlantMetrics& plant) {
  if (plant.oscillation && plant.oscillation->frequency) {
    Print("; steering oscillates by {:.3g} rad at {:.3g} Hz", plant.oscillation->amplitude,
          *plant.oscillation->frequency);
  }
}

}  // namespace

void PrintSummary(const RunResult& result, const std::filesystem::path& folder) {
  Print("{}: {}, in {}\n", result.scenario.name,
        result.interrupted       ? Colorize(Tone::kDoubtful, "interrupted")
        : !result.verdict.judged ? SafeText{"finished, no expectations"}
        : result.verdict.passed  ? Colorize(Tone::kGood, "passed")
                                 : Colorize(Tone::kBad, "FAILED"),
        folder.string());
  for (const PlantMetrics& plant : result.metrics) {
    Print("  {:<10} ", plant.plant);
    if (plant.status == DriveStatus::kCollided) {
      Print("{} at {:.2f} s, followed until {:.2f} s, {:.2f} m", InWords(plant.status),
            plant.contact_t, plant.time, plant.distance);
    } else {
      const bool mishap =
          plant.status == DriveStatus::kRolledOver || plant.status == DriveStatus::kJackknifed;
      Print("{} {} {:.2f} s, {:.2f} m", InWords(plant.status), mishap ? "at" : "after", plant.time,
            plant.distance);
    }
    if (plant.tracking) {
      const TrackingMetrics& tracking = *plant.tracking;
      Print("; cross-track error max {:.4f} m, rms {:.4f} m; goal distance {:.4f} m",
            tracking.cross_track_max, tracking.cross_track_rms, tracking.goal_distance);
      PrintOscillation(plant);
    }
    Print("\n");
    if (plant.maneuver) {
      PrintManeuver(*plant.maneuver);
    }
    if (plant.recorded) {
      PrintRecord(plant);
    }
  }
  for (const PlantComparison& between : result.comparisons) {
    Print("  {} - {}: position max {:.4f} m, heading max {:.4f} rad\n", between.first,
          between.second, between.position.max, between.heading.max);
  }
  for (const std::string& failure : result.verdict.failures) {
    Print("  {}\n", failure);
  }
  for (const std::string& note : result.verdict.notes) {
    Print("  {}\n", note);
  }
  std::fflush(stdout);  // flush now, because the following work takes time and may fail
}

void PrintFailures(const RunResult& result) {
  for (const std::string& failure : result.verdict.failures) {
    PrintTo(stderr, "{}: {}\n", result.scenario.name, failure);
  }
}

ExitCode ExitCodeOf(const RunResult& result) {
  const bool failed = result.verdict.judged && !result.verdict.passed;
  return result.interrupted ? kInterrupted : failed ? kFailedExpectations : kOk;
}

}  // namespace trackbed::cli
