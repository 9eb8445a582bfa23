#include "render/intervening_aids.h"

#include <fmt/format.h>

#include <utility>

#include "trackbed/sim/car_model.h"

namespace trackbed::render {

std::optional<std::string> InterveningAids(const TimedTable& log, const TimedTable::Place& place) {
  bool has_aids = false;
  std::string names;
  for (const auto& [name, pattern] :
       {std::pair("ABS", "abs_active_{}"), std::pair("ESC", "esc_brake_torque_{}_Nm")}) {
    bool acts = false;
    for (const char* wheel : kWheels) {
      if (const auto column = log.Find(fmt::format(fmt::runtime(pattern), wheel))) {
        has_aids = true;
        acts = acts || log.table().at(place.row, *column) > 0.0;
      }
    }
    if (acts) {
      names += names.empty() ? name : fmt::format(" {}", name);
    }
  }
  if (!has_aids) {
    return std::nullopt;
  }
  return names.empty() ? "-" : names;
}

}  // namespace trackbed::render
