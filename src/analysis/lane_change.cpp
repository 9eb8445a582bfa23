#include "trackbed/planning/course/lane_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/analysis/evaluations.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

namespace trackbed {

namespace {

/// Limit of ISO 3888 for the smallest distance between the car's footprint and a gate's edge [m]:
/// no corner of the footprint may leave a gate.
constexpr StandardLimit kInsideGates{StandardLimit::Relation::kAtLeast, 0.0};

}  // namespace

std::vector<ManeuverMetric> MethodMetrics(const LaneChangeOptions& /*options*/) {
  return {{"margin", "minimum gate margin", "m", true, kInsideGates},
          {"margin_gate", "section of the minimum margin", ""},
          {"margin_1", "margin in section 1", "m"},
          {"margin_3", "margin in section 3", "m"},
          {"margin_5", "margin in section 5", "m"},
          {"entry_speed", "entry speed", "m/s", true},
          {"speed_loss", "speed loss", "m/s"}};
}

void Evaluate(const LaneChangeOptions&, const ManeuverInput& input, ManeuverMetrics& metrics) {
  const std::vector<Gate>& gates = input.plan.gates;
  if (gates.empty()) {
    metrics.missing = "the plan has no gates";
    return;
  }
  // Returns how far the car's foremost corner is beyond the center of the gate, in the direction of
  // the gate [m].
  const auto foremost = [&](const LogRow& row, const Gate& gate) {
    double x = -std::numeric_limits<double>::infinity();
    for (const Vec2& corner : FootprintAt(input.vehicle, row.state.pose).Corners()) {
      x = std::max(x, ToLocal(gate.lane.center, corner).x());
    }
    return x;
  };
  const auto hindmost = [&](const LogRow& row, const Gate& gate) {
    double x = std::numeric_limits<double>::infinity();
    for (const Vec2& corner : FootprintAt(input.vehicle, row.state.pose).Corners()) {
      x = std::min(x, ToLocal(gate.lane.center, corner).x());
    }
    return x;
  };
  std::vector<Pose2> poses;
  std::optional<double> entry;
  std::optional<double> exit;
  for (const LogRow& row : input.log.rows) {
    poses.push_back(row.state.pose);
    if (!entry && foremost(row, gates.front()) >= -0.5 * gates.front().lane.length) {
      entry = row.state.speed;
      metrics.begin = row.state.time;
    }
    if (entry && hindmost(row, gates.back()) >= 0.5 * gates.back().lane.length) {
      exit = row.state.speed;
      metrics.end = row.state.time;
      break;
    }
  }
  const std::vector<double> margins = GateMargins(gates, input.vehicle, poses);
  const auto smallest = std::min_element(margins.begin(), margins.end());
  metrics.passed = exit.has_value() && kInsideGates.Met(*smallest);
  if (std::isfinite(*smallest)) {
    metrics.values.emplace_back("margin", *smallest);
    metrics.values.emplace_back(
        "margin_gate", gates[static_cast<std::size_t>(smallest - margins.begin())].section);
  }
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (std::isfinite(margins[i])) {
      metrics.values.emplace_back(fmt::format("margin_{}", gates[i].section), margins[i]);
    }
  }
  if (entry) {
    metrics.values.emplace_back("entry_speed", *entry);
  }
  if (exit) {
    metrics.values.emplace_back("speed_loss", *entry - *exit);
  } else {
    metrics.missing = "the car does not pass the last gate";
  }
}

}  // namespace trackbed
