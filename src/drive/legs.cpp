#include "src/drive/legs.h"

#include <vector>

#include "trackbed/planning/common/plan.h"

namespace trackbed {

std::deque<Plan> InLegs(const Plan& plan) {
  const std::vector<Stations> legs = LegsOf(plan.reference.path, plan.stops);
  if (legs.size() == 1) {
    return {plan};
  }
  std::deque<Plan> plans;
  for (const Stations& leg : legs) {
    Plan& own = plans.emplace_back(plan);
    own.stops.clear();
    own.reference = Excerpt(plan.reference, leg);
    own.schedule_speed = Excerpt(plan.schedule_speed, leg);
    own.schedule = plan.schedule.From(leg.from);
  }
  return plans;
}

int GearOf(const Plan& plan) {
  return plan.reference.path.At(0.0).direction;
}

}  // namespace trackbed
