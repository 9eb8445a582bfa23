#pragma once

#include <utility>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

/// Logs configurations at the first physics step at or after every multiple of a period.
class ConfigurationLog {
 public:
  ConfigurationLog(const CarModel& car, const World& world, double period);

  void Record(const Plant& plant, double time);

  Table Take() { return std::move(table_); }

 private:
  [[nodiscard]] std::size_t Find(const std::string& column) const;

  double period_;
  long next_ = 0;
  Table table_;
  std::vector<std::pair<std::size_t, double>> moving_;  // column and speed [m/s] of obstacles
};

}  // namespace trackbed
