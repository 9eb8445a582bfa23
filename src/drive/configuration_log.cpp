#include "src/drive/configuration_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

std::vector<std::string> Columns(const CarModel& car) {
  std::vector<std::string> columns{"t_s"};
  const std::vector<std::string> configuration = car.configuration_columns();
  columns.insert(columns.end(), configuration.begin(), configuration.end());
  return columns;
}

}  // namespace

ConfigurationLog::ConfigurationLog(const CarModel& car, const World& world, double period)
    : period_(period), table_(Columns(car)) {
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    const Obstacle& obstacle = world.obstacles[i];
    if (obstacle.moves()) {
      moving_.emplace_back(Find(fmt::format("obstacle_{}_x_m", i)), obstacle.velocity.x());
      moving_.emplace_back(Find(fmt::format("obstacle_{}_y_m", i)), obstacle.velocity.y());
    }
  }
}

void ConfigurationLog::Record(const Plant& plant, double time) {
  // Half a microsecond: times are sums of timesteps and may fall short of the multiple by rounding.
  if (time + 5e-7 < period_ * static_cast<double>(next_)) {
    return;
  }
  std::vector<double> row{time};
  const std::vector<double> configuration = plant.Configuration();
  row.insert(row.end(), configuration.begin(), configuration.end());
  for (const auto& [column, speed] : moving_) {
    row[column] = speed * time;  // whatever the plant knows of it
  }
  table_.AddRow(row);
  next_ = static_cast<long>(std::floor((time + 5e-7) / period_)) + 1;
}

std::size_t ConfigurationLog::Find(const std::string& column) const {
  const auto& columns = table_.columns();
  const auto found = std::find(columns.begin(), columns.end(), column);
  TRACKBED_CHECK(found != columns.end(), "configurations have no column '{}'", column);
  return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace trackbed
