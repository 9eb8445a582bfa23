#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/target.h"
#include "trackbed/path_files/commonroad_scenario.h"

/// Reads the input as a CommonRoad scenario. Aborts if the scenario breaks a guarantee that the
/// header `commonroad_scenario.h` gives.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  return fuzz::Expect([&] {
    const CommonRoadScenario scenario =
        ReadCommonRoadScenario("scenario.xml", fuzz::Text(data, size));
    bool kept = scenario.start_speed >= 0.0 && scenario.speed >= 0.1 &&
                scenario.route.size() >= 2 && scenario.start.position().allFinite() &&
                std::isfinite(scenario.goal_yaw);
    for (const Vec2& point : scenario.route) {
      kept = kept && point.allFinite();
    }
    for (const CommonRoadObstacle& obstacle : scenario.obstacles) {
      kept = kept && obstacle.poses.size() != 1;
      for (std::size_t i = 0; i < obstacle.poses.size(); ++i) {
        kept = kept && obstacle.poses[i].second.position().allFinite() &&
               (i == 0 || obstacle.poses[i - 1].first < obstacle.poses[i].first);
      }
    }
    if (!kept) {
      std::abort();
    }
  });
}
