#include "src/drive/legs.h"

#include <utility>
#include <vector>

namespace trackbed {

std::deque<Plan> InLegs(const Plan& plan) {
  const std::vector<Stations> legs = LegsOf(plan.reference.path);
  if (legs.size() == 1) {
    return {plan};
  }
  std::deque<Plan> plans;
  for (const Stations& leg : legs) {
    Plan& own = plans.emplace_back(plan);
    own.reference = Excerpt(plan.reference, leg);
    own.schedule_speed = Excerpt(plan.schedule_speed, leg);
    std::vector<SteeringSchedule::Knot> knots{{0.0, plan.schedule.At(leg.from)}};
    for (const SteeringSchedule::Knot& knot : plan.schedule.knots()) {
      if (knot.distance > leg.from) {
        knots.push_back({knot.distance - leg.from, knot.steering});
      }
    }
    own.schedule = SteeringSchedule::Through(std::move(knots));
  }
  return plans;
}

int GearOf(const Plan& plan) {
  return plan.reference.path.At(0.0).direction;
}

}  // namespace trackbed
