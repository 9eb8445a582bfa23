#include "src/scenario/check_expectations.h"

#include "src/scenario/cross_check.h"

namespace trackbed {
namespace {

using EachExpectation =
    std::function<void(const std::string& key, const PlantExpectation& expectation)>;

void CheckPlants(Diagnostics& c) {
  if (c.scenario.drive.plants.empty()) {
    c.AddError("drive.plants", "must name at least one plant");
  }
  for (const auto& [plant, expectation] : c.scenario.expect.plants) {
    if (!Drives(c.scenario, plant)) {
      c.AddError("expect." + plant, fmt::format("not in drive.plants: {}", c.Driven()));
    }
  }
}

void CheckTwoPlants(Diagnostics& c, const std::string& key,
                    const std::vector<std::string>& plants) {
  if (plants.size() != 2) {
    c.AddError(key, fmt::format("expected two plants, found {}", plants.size()));
    return;
  }
  for (const std::string& plant : plants) {
    if (c.CouldRead({"drive.plants"}) && !Drives(c.scenario, plant)) {
      c.AddError(key, fmt::format("{} is not in drive.plants: {}", plant, c.Driven()));
    }
  }
}

void CheckBetween(Diagnostics& c) {
  for (std::size_t i = 0; i < c.scenario.expect.between.size(); ++i) {
    const BetweenExpectation& between = c.scenario.expect.between[i];
    const std::string key = fmt::format("expect.between[{}]", i);
    if (c.could_read(key + ".plants")) {
      CheckTwoPlants(c, key + ".plants", between.plants);
    }
    const auto could_read = [&](const char* bound) { return c.could_read(key + "." + bound); };
    if (!between.bounds.any() && could_read("position_max") && could_read("heading_max") &&
        could_read("yaw_rate_max") && could_read("steering_max")) {
      c.AddError(key,
                 "no bound given; give position_max, heading_max, yaw_rate_max or steering_max");
    }
  }
}

void ForEachExpectation(Diagnostics& c, const EachExpectation& call) {
  call("expect", c.scenario.expect.all);
  for (const auto& [plant, expectation] : c.scenario.expect.plants) {
    call("expect." + plant, expectation);
  }
}

void CheckMetrics(Diagnostics& c) {
  ForEachExpectation(c, [&](const std::string& key, const PlantExpectation& expectation) {
    for (std::size_t i = 0; i < expectation.metrics.size(); ++i) {
      const MetricExpectation& metric = expectation.metrics[i];
      const std::string own = fmt::format("{}.metrics[{}]", key, i);
      if (!metric.min && !metric.max && !metric.equals && c.could_read(own + ".min") &&
          c.could_read(own + ".max") && c.could_read(own + ".equals")) {
        c.AddError(own, "no bound given; give min, max or equals");
      }
      if (metric.min && metric.max && *metric.min > *metric.max) {
        c.AddError(own, fmt::format("min {} is above max {}", *metric.min, *metric.max));
      }
    }
  });
}

/// Rejects expectations on quantities that the run does not measure. For example, cross-track
/// errors are measured only in scenarios with a plan. Clearances are measured only in scenarios
/// with obstacles, or with the edges of a track or of roads.
void CheckMeasuredQuantities(Diagnostics& c) {
  const bool has_path = c.scenario.plan || !c.CouldReadPlan({"method"});
  const bool has_obstacles =
      HasObstacles(c.scenario.world) || !c.CouldRead({"world.obstacles", "world.map"});
  const MissionSpec& mission = c.scenario.mission;
  const bool has_edges =
      mission.track || !mission.route.empty() || !c.CouldRead({"mission.track", "mission.route"});
  ForEachExpectation(c, [&](const std::string& key, const PlantExpectation& expectation) {
    if (!has_path && (expectation.reach_goal || expectation.max_cross_track ||
                      expectation.rms_cross_track || expectation.max_heading_error)) {
      c.AddError(key, "goal and path expectations need a plan");
    }
    if (expectation.max_hitch_angle && !c.scenario.vehicle.trailer &&
        c.could_read("vehicle.trailer")) {
      c.AddError(key + ".max_hitch_angle",
                 "the car has no trailer; remove this, or add "
                 "vehicle.trailer");
    }
    if (has_obstacles) {
      return;
    }
    const char* none = c.scenario.world.map ? "; no cell of world.map is blocked" : "";
    if (expectation.min_clearance && !has_edges) {
      c.AddError(key, fmt::format("min_clearance needs world.obstacles, world.map, mission.track "
                                  "or mission.route{}",
                                  none));
    }
    if (expectation.collision.value_or(false)) {
      c.AddError(key, fmt::format("collision needs world.obstacles or world.map{}", none));
    }
  });
}

}  // namespace

void CheckExpectations(Diagnostics& c) {
  if (c.CouldRead({"drive.plants"})) {
    CheckPlants(c);
  }
  CheckBetween(c);
  CheckMeasuredQuantities(c);
  CheckMetrics(c);
}

}  // namespace trackbed
