#include "trackbed/drive/start_overlap.h"

#include <fmt/format.h>

#include "trackbed/scenario/initial_state.h"
#include "trackbed/world/world.h"

namespace trackbed {

std::string StartOverlap(const Scenario& scenario, const VehicleParams& vehicle) {
  // Touching boxes overlap by rounding errors, at coordinates of kilometers by 1e-12 m.
  constexpr double kRounding = 1e-9;  // [m]
  const Pose2 start = InitialState(scenario, vehicle).pose;
  const OrientedBox footprint = FootprintAt(vehicle, start);
  const auto explain = [&](const std::string& what, const OrientedBox& box) {
    const double depth = -Separation(footprint, box);
    return depth <= kRounding
               ? std::string()
               : fmt::format(
                     "{} at ({:.4g}, {:.4g}) overlaps the car, which starts at ({:.4g}, {:.4g}), "
                     "by {:.3g} m; move one of them by at least this distance",
                     what, box.center.x, box.center.y, start.x, start.y, depth);
  };
  for (std::size_t i = 0; i < scenario.world.obstacles.size(); ++i) {
    if (std::string why = explain(fmt::format("world.obstacles[{}]", i),
                                  FootprintAt(scenario.world.obstacles[i], 0.0));
        !why.empty()) {
      return why;
    }
  }
  for (const OrientedBox& wall : MapWalls(scenario.world)) {
    if (std::string why = explain("a wall of world.map", wall); !why.empty()) {
      return why;
    }
  }
  return "";
}

}  // namespace trackbed
