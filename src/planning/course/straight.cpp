#include "trackbed/planning/course/straight.h"

#include <vector>

#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/course_schedule.h"

namespace trackbed {
namespace {

Plan PlanWith(const StraightOptions& options, const PlanRequest& request) {
  const std::vector<Segment> segments{{.length = options.length}};
  Plan plan;
  plan.reference.path = Path(request.start, segments);
  plan.reference.speed = StopAtEnd(options.length, request.start_speed, request.speed);
  plan.schedule = CourseSchedule(request.vehicle, segments, request.speed.speed);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = plan.reference.path.At(options.length).pose;
  return plan;
}

}  // namespace

void Visit(KeyVisitor& keys, StraightOptions& options) {
  keys.Field({"length", "m", "length of the line, from the car's start"}, options.length,
             Need::kOptional, Range{.max = kMaxPathLength, .above = 0.0});
}

PlannerEntry StraightPlanner() {
  return {.name = "straight",
          .summary = "a straight line, at the mission's speed to a stop",
          .defaults = StraightOptions{},
          .plan = PlanBy<StraightOptions, PlanWith>};
}

}  // namespace trackbed
