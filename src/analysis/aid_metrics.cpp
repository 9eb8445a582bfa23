#include "src/analysis/aid_metrics.h"

#include <fmt/format.h>

#include <algorithm>

#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

/// Returns the time for which a driver aid acts, judged by `acts` at the start of each control
/// period [s]; nullopt if the car lacks the aid.
template <typename Acts>
std::optional<MetricReading> TimeOfAid(const MetricInput& input, const Acts& acts) {
  const auto& rows = input.log.rows;
  if (!rows.front().aids || !acts(*rows.front().aids)) {
    return std::nullopt;
  }
  double time = 0.0;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (*acts(*rows[i].aids)) {
      time += rows[i + 1].state.time - rows[i].state.time;
    }
  }
  return MetricReading{time, {}};
}

double LargestTorque(const EscState& esc) {
  return *std::max_element(esc.brake_torque.begin(), esc.brake_torque.end());
}

}  // namespace

std::optional<MetricReading> TimeOfAbs(const MetricInput& input) {
  return TimeOfAid(input, [](const AidState& aids) -> std::optional<bool> {
    if (!aids.abs_active) {
      return std::nullopt;
    }
    return std::any_of(aids.abs_active->begin(), aids.abs_active->end(),
                       [](bool active) { return active; });
  });
}

std::optional<MetricReading> TimeOfEsc(const MetricInput& input) {
  return TimeOfAid(input, [](const AidState& aids) -> std::optional<bool> {
    return aids.esc ? std::optional(LargestTorque(*aids.esc) > 0.0) : std::nullopt;
  });
}

std::optional<MetricReading> LargestEscTorque(const MetricInput& input) {
  const auto& rows = input.log.rows;
  if (!rows.front().aids || !rows.front().aids->esc) {
    return std::nullopt;
  }
  double largest = 0.0;
  for (const LogRow& row : rows) {
    largest = std::max(largest, LargestTorque(*row.aids->esc));
  }
  return MetricReading{largest, {}};
}

void NoteIgnoredAids(const Scenario& scenario, const std::vector<RunLog>& logs,
                     std::vector<std::string>& notes) {
  if (!scenario.vehicle.aids || !scenario.vehicle.aids->any()) {
    return;
  }
  for (const RunLog& log : logs) {
    if (log.plant != kRecordedPlant && !log.rows.front().aids) {
      notes.push_back(fmt::format(
          "{}: ignores vehicle.aids; only the plants mujoco and mujoco:magic_formula have wheels "
          "that lock and spin",
          log.plant));
    }
  }
}

}  // namespace trackbed
