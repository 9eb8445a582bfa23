#include "src/drive/configuration_log.h"

#include <fmt/format.h>

#include <cmath>

namespace trackbed {
namespace {

std::vector<std::string> WithTime(const std::vector<std::string>& configuration) {
  std::vector<std::string> columns{"t_s"};
  columns.insert(columns.end(), configuration.begin(), configuration.end());
  return columns;
}

}  // namespace

ConfigurationLog::ConfigurationLog(const std::vector<std::string>& columns, const World& world,
                                   double period)
    : period_(period), table_(WithTime(columns)) {
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    const Obstacle& obstacle = world.obstacles[i];
    if (obstacle.moves()) {
      AddMoving(fmt::format("obstacle_{}_x_m", i), obstacle, &Pose2::x);
      AddMoving(fmt::format("obstacle_{}_y_m", i), obstacle, &Pose2::y);
      AddMoving(fmt::format("obstacle_{}_yaw_rad", i), obstacle, &Pose2::yaw);
    }
  }
}

void ConfigurationLog::Record(const Plant& plant, double time) {
  if (table_.columns().size() == 1) {
    return;
  }
  // Use a tolerance of half a microsecond, because rounding may make the sum of the timesteps
  // slightly smaller than a multiple of the logging period.
  if (time + 5e-7 < period_ * static_cast<double>(next_)) {
    return;
  }
  AddRow(plant, time);
  next_ = static_cast<long>(std::floor((time + 5e-7) / period_)) + 1;
}

void ConfigurationLog::RecordEnd(const Plant& plant, double time) {
  const std::size_t rows = table_.rows();
  if (table_.columns().size() > 1 && !plant.diverged() &&
      (rows == 0 || table_.at(rows - 1, 0) + 5e-7 < time)) {
    AddRow(plant, time);
  }
}

void ConfigurationLog::AddRow(const Plant& plant, double time) {
  const std::vector<double> configuration = plant.Configuration();
  row_.assign(1, time);
  row_.insert(row_.end(), configuration.begin(), configuration.end());
  for (const Moving& moving : moving_) {
    row_[moving.column] = MotionAt(moving.obstacle, time).displacement.*moving.coordinate;
  }
  table_.AddRow(row_);
}

void ConfigurationLog::AddMoving(const std::string& column, const Obstacle& obstacle,
                                 double Pose2::*coordinate) {
  if (const int found = table_.Find(column); found >= 0) {
    moving_.push_back({static_cast<std::size_t>(found), obstacle, coordinate});
  }
}

}  // namespace trackbed
