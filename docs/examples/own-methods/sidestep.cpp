#include <trackbed/planning/common/course_schedule.h>
#include <trackbed/planning/common/curvature_steps.h>
#include <trackbed/planning/common/planner.h>

#include <cmath>

using namespace trackbed;

/// Options of a planner that drives straight on, changes to the lane on the left by two arcs, and
/// drives straight on.
struct SidestepOptions {
  double offset = 3.5;   ///< Distance of the lane on the left from the start lane [m], > 0.
  double radius = 15.0;  ///< Radius of both arcs of the lane change [m], > 0.
};

void Visit(KeyVisitor& keys, SidestepOptions& options) {
  keys.Field({"offset", "m", "to the left"}, options.offset, Need::kOptional, kPositive);
  keys.Field({"radius", "m", "of both arcs"}, options.radius, Need::kOptional, kPositive);
}

/// Values that plan.json and `trackbed plan` show only for this planner.
struct SidestepDiagnostics {
  double turn = 0.0;  ///< Heading change along each arc [rad].
};

void Visit(DiagnosticsVisitor& out, const SidestepDiagnostics& own) {
  out.Number("turn_rad", own.turn);
}

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
  // Drive slowly at the curvature steps, because the wheels need time to turn.
  plan.caps = PlanSteps(request.vehicle, segments, 0.3).caps;
  plan.reference.speed = StopAtEnd(length, request.start_speed, request.speed, plan.caps);
  plan.schedule = CourseSchedule(request.vehicle, segments, request.speed.speed, plan.caps);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = plan.reference.path.At(length).pose;
  plan.diagnostics.planner = SidestepDiagnostics{turn};
  return plan;
}

PlannerEntry Sidestep() {
  return {.name = "sidestep",
          .summary = "an S to the lane on the left",
          .defaults = SidestepOptions{},
          .plan = PlanBy<SidestepOptions, PlanWith>};
}
