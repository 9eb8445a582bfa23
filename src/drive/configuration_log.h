#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/sim/plant.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Logs the plant's configuration vector (joint positions) once per logging period, and at the end
/// of the run. The plant is logged at the first physics step at or after each multiple of the
/// logging period.
class ConfigurationLog {
 public:
  /// `columns` names the components of the plant's configuration vector. If `columns` is empty, no
  /// configurations are logged. The columns of moving obstacles contain the planned positions of
  /// the obstacles, even if the plant does not simulate the obstacles.
  ConfigurationLog(const std::vector<std::string>& columns, const World& world, double period);

  /// Logs the plant's configuration at `time` [s] if a logging period has passed.
  void Record(const Plant& plant, double time);
  /// Logs the plant's configuration at the end of the run, at `time` [s], unless Record has already
  /// logged it or the plant has diverged.
  void RecordEnd(const Plant& plant, double time);

  /// Returns the table of configurations logged so far.
  [[nodiscard]] const Table& table() const { return table_; }

  Table Take() { return std::move(table_); }

 private:
  /// A log column of a moving obstacle, which contains one coordinate of the obstacle's
  /// displacement.
  struct Moving {
    std::size_t column = 0;
    Obstacle obstacle;
    double Pose2::*coordinate = nullptr;
  };

  void AddRow(const Plant& plant, double time);
  void AddMoving(const std::string& column, const Obstacle& obstacle, double Pose2::*coordinate);

  double period_;
  long next_ = 0;
  Table table_;
  std::vector<double> row_;  // The last row of the table of configurations.
  std::vector<Moving> moving_;
};

}  // namespace trackbed
