#include "trackbed/sim/tyre_grip.h"

#include <algorithm>

#include "src/sim/contact_friction.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

double ContactFriction(const mjModel& model, int tyre) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  const double of_tyre = model.geom_friction[3 * tyre];
  const double of_ground = model.geom_friction[3 * ground];
  const int ahead = model.geom_priority[tyre] - model.geom_priority[ground];
  return ahead > 0 ? of_tyre : ahead < 0 ? of_ground : std::max(of_tyre, of_ground);
}

TyreFriction FindTyreFriction(const CarModel& car, TyreLaw law, std::size_t wheel, double load) {
  const CarParts& parts = car.parts();
  TRACKBED_CHECK(wheel < parts.tyre.size(), "wheel {}", wheel);
  if (SelectTyreLaw(car, law) == TyreLaw::kMagicFormula && parts.tyres) {
    return PeakFriction(parts.tyres->axle.at(wheel / 2), load);
  }
  const double friction = ContactFriction(*car.get(), parts.tyre.at(wheel));
  return {friction, friction};
}

}  // namespace trackbed
