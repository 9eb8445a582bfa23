#include <cmath>
#include <cstdio>

#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/plan.h"

using namespace trackbed;

/// Straight on, an S to the lane on the left, straight on.
struct SidestepOptions {
  double offset = 3.5;  ///< [m]
  double radius = 15.0;
};

Plan PlanWith(const SidestepOptions& options, const PlanRequest& request) {
  Plan plan;
  if (options.radius < request.vehicle.min_turning_radius() || options.offset > options.radius) {
    plan.status = PlanStatus::kTurnTooTight;
    plan.reason = "the car cannot step aside so far on such a radius";
    return plan;
  }
  const double turn = std::acos(1.0 - 0.5 * options.offset / options.radius);
  const double arc = options.radius * turn;
  const std::vector<Segment> segments{{.length = 15.0},
                                      {.length = arc, .curvature = 1.0 / options.radius},
                                      {.length = arc, .curvature = -1.0 / options.radius},
                                      {.length = 15.0}};
  plan.reference.path = Path(request.start, segments);
  const double length = plan.reference.path.length();
  plan.caps = PlanSteps(request.vehicle, segments, 0.3).caps;  // the wheels need time to turn
  plan.reference.speed = StopAtEnd(length, request.start_speed, request.speed, plan.caps);
  plan.schedule = CourseSchedule(request.vehicle, segments, request.speed.speed, plan.caps);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = plan.reference.path.At(length).pose;
  return plan;
}

/// Drives it in place of the plan of a scenario, whose path is given.
int main(int /*argc*/, char** argv) {
  const Scenario scenario = ReadScenario(argv[1]);
  const CarModel car = LoadCar(scenario);
  PlanRequest request{.vehicle = car.params(), .waypoints = {}, .start = StartOf(scenario).pose};
  request.speed = {.speed = scenario.mission.speed, .acceleration = 1.0, .deceleration = 1.5};
  const Plan plan = PlanWith(SidestepOptions{}, request);
  bool arrived = plan.ok();
  for (const char* plant : {"kinematic", "mujoco"}) {
    const RunLog log = DrivePlant(scenario, car, plan, plant);
    const Vec2 missed = log.rows.back().state.pose.position() - plan.goal.position();
    std::printf("%s: %s, %.3f m from the goal\n", plant, ToString(log.status), missed.norm());
    arrived = arrived && log.status == DriveStatus::kArrived && missed.norm() < 0.2;
  }
  return arrived ? 0 : 1;
}
