#include "trackbed/drive/start_overlap.h"

#include <fmt/format.h>

#include "trackbed/scenario/initial_state.h"
#include "trackbed/world/world.h"

namespace trackbed {

std::string StartOverlap(const Scenario& scenario, const VehicleParams& vehicle) {
  // Overlap of two boxes that is ignored [m], because rounding errors make touching boxes overlap
  // by 1e-12 m at coordinates of kilometers.
  constexpr double kRounding = 1e-9;  // [m]
  const StartState state = InitialState(scenario, vehicle);
  const Pose2& start = state.pose;
  const OrientedBox footprint = FootprintAt(vehicle, start);
  std::optional<OrientedBox> towed;
  if (const std::optional<TrailerOptions>& trailer = scenario.vehicle.trailer) {
    const TrailerParams params = MakeTrailer(*trailer, vehicle);
    towed = TrailerFootprint(params, TrailerPose(params, start, state.hitch_angle));
  }
  const auto explain = [&](const std::string& what, const OrientedBox& box) {
    const auto overlap = [&](const OrientedBox& body, const char* name) {
      const double depth = -Separation(body, box);
      return depth <= kRounding
                 ? std::string()
                 : fmt::format(
                       "{} at ({:.4g}, {:.4g}) overlaps the {}, which starts at ({:.4g}, {:.4g}), "
                       "by {:.3g} m; move one of them by at least this distance",
                       what, box.center.x, box.center.y, name, start.x, start.y, depth);
    };
    std::string why = overlap(footprint, "car");
    return why.empty() && towed ? overlap(*towed, "trailer of the car") : why;
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
