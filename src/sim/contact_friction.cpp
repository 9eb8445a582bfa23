#include "src/sim/contact_friction.h"

#include <algorithm>

namespace trackbed {

double ContactFriction(const mjModel& model, int tyre) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  const double of_tyre = model.geom_friction[3 * tyre];
  const double of_ground = model.geom_friction[3 * ground];
  const int ahead = model.geom_priority[tyre] - model.geom_priority[ground];
  return ahead > 0 ? of_tyre : ahead < 0 ? of_ground : std::max(of_tyre, of_ground);
}

}  // namespace trackbed
