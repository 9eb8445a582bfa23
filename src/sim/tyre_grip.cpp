#include "trackbed/sim/tyre_grip.h"

#include "src/sim/contact_friction.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

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
