#include "src/analysis/peaks.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

void MeasureLateralAcceleration(const RunLog& log, std::size_t window, PlantMetrics& metrics) {
  const std::size_t rows = std::min(window + 1, log.rows.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    if (log.contact_time && log.rows[i].state.time > *log.contact_time) {
      break;  // ignore the rows after contact, in which the obstacle pushes the car
    }
    sum += log.rows[i].state.lateral_acceleration;
    if (i >= rows) {
      sum -= log.rows[i - rows].state.lateral_acceleration;
    }
    const double mean = std::abs(sum) / static_cast<double>(rows);
    if (i + 1 >= rows && mean > metrics.lateral_acceleration_max) {
      const LogRow& middle = log.rows[i - rows / 2];
      metrics.lateral_acceleration_max = mean;
      metrics.lateral_acceleration_max_s = RowStation(middle);
      metrics.lateral_acceleration_max_t = middle.state.time;
    }
  }
}

void MeasureSteering(const RunLog& log, std::size_t window, PlantMetrics& metrics) {
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const VehicleState& state = log.rows[i].state;
    if (log.contact_time && state.time > *log.contact_time) {
      break;  // ignore the rows after contact, in which an obstacle may turn the wheels
    }
    metrics.steering_max = std::max(metrics.steering_max, std::abs(state.steering));
    if (i < window) {
      continue;
    }
    const VehicleState& before = log.rows[i - window].state;
    const double rate = std::abs(state.steering - before.steering) / (state.time - before.time);
    if (rate > metrics.steering_rate_max) {
      metrics.steering_rate_max = rate;
      metrics.steering_rate_max_s = RowStation(log.rows[i]);
      metrics.steering_rate_max_t = state.time;
    }
  }
}

double SaturatedFraction(const RunLog& log, const VehicleParams& vehicle, double begin,
                         double end) {
  // Fraction of a steering limit above which the actuator counts as being at the limit. The margin
  // of a thousandth covers rounding errors and the tolerances of controllers that solve for a
  // command.
  constexpr double kAtLimit = 0.999;
  const auto reaches = [](double value, double limit) {
    return limit > 0.0 && value >= kAtLimit * limit;
  };
  double saturated = 0.0;
  double periods = 0.0;
  for (std::size_t i = 0; i + 1 < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    const VehicleState& after = log.rows[i + 1].state;
    if (row.state.time < begin || after.time > end) {
      continue;
    }
    const double period = after.time - row.state.time;
    const double turned = std::abs(after.steering_actuator - row.state.steering_actuator);
    const bool limited = reaches(turned, vehicle.steering_rate * period) ||
                         reaches(std::abs(after.steering_actuator), vehicle.steering_limit);
    saturated += limited ? 1.0 : 0.0;
    periods += 1.0;
  }
  return periods > 0.0 ? saturated / periods : 0.0;
}

}  // namespace trackbed
