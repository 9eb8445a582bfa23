#include <trackbed/trackbed.h>

#include <cstdio>

// Plans a turn, simulates the turn on two plants, and compares the plants: how far from the
// kinematic car does the car with tyres drive?
int main() {
  trackbed::Scenario scenario;
  scenario.name = "corner";
  scenario.vehicle.model = "prius";
  scenario.mission.speed = 3.0;                                          // [m/s]
  scenario.mission.waypoints = {{0.0, 0.0}, {30.0, 0.0}, {30.0, 30.0}};  // [m]
  scenario.plan = trackbed::PlanSpec{.global = trackbed::FilletOptions{}};
  scenario.control.steering = trackbed::PreviewOptions{.distance = 2.5};
  scenario.drive.plants = {"kinematic", "mujoco"};

  const trackbed::RunResult run = trackbed::RunScenario(scenario);
  if (!run.plan.ok()) {
    std::printf("no plan: %s\n", run.plan->reason.c_str());
    return 1;
  }
  for (const char* plant : {"kinematic", "mujoco"}) {
    const auto [log, metrics] = *run.Find(plant);
    std::printf("%s: %zu rows, largest cross-track error %.4f m\n", plant, log.rows.size(),
                metrics.tracking->cross_track_max);
  }
  const trackbed::PlantComparison apart = trackbed::Compare(run, "kinematic", "mujoco");
  std::printf("at most %.4f m apart\n", apart.position.max);
}
