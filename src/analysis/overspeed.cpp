#include "src/analysis/overspeed.h"

#include <algorithm>

#include "trackbed/world/world.h"

namespace trackbed {

std::optional<double> OverspeedLimit(const RunLog& log, const Scenario& scenario,
                                     const VehicleParams& vehicle) {
  const bool planned = std::any_of(log.rows.begin(), log.rows.end(),
                                   [](const LogRow& row) { return row.planned_speed.has_value(); });
  if (!planned) {
    return std::nullopt;
  }
  double road = 0.0;
  for (const LogRow& row : log.rows) {
    road = std::max(road, RoadFactor(scenario.world, row.state.pose.position()));
  }
  const SpeedControlOptions& speed = scenario.control.speed;
  // Largest deceleration of the car at the highest friction of the run [m/s^2]; 0 if unknown.
  const double hardest = MaxDeceleration(vehicle, road);
  // Largest deceleration that SpeedControl commands [m/s^2].
  const double most = 2.0 * speed.deceleration;
  const double braking = hardest > 0.0 ? std::min(most, hardest) : most;
  return braking / speed.gain + braking * scenario.drive.control_period;
}

}  // namespace trackbed
