#include "src/sim/exact_plant.h"
#include "src/sim/plants.h"
#include "trackbed/vehicle/towing_car.h"

namespace trackbed {
namespace {

KinematicState StateAt(const VehicleParams& params, const StartState& start,
                       ReferencePoint reference) {
  KinematicState state = InPlane(start);
  if (reference == ReferencePoint::kCenterOfGravity) {
    const Vec2 cg = ToWorld(start.pose, {params.cg_to_rear, 0.0});
    state.pose.x = cg.x();
    state.pose.y = cg.y();
  }
  return state;
}

}  // namespace

std::unique_ptr<Plant> MakeIdealKinematicPlant(const PlantSetup& setup, ReferencePoint reference) {
  const KinematicState start = StateAt(setup.car.params(), setup.start, reference);
  if (const std::optional<TrailerParts>& trailer = setup.car.trailer()) {
    return std::make_unique<ExactPlant<TowingCar>>(
        setup.car,
        TowingCar(Steered(setup), reference, start, trailer->params, setup.start.hitch_angle));
  }
  return std::make_unique<ExactPlant<KinematicCar>>(setup.car,
                                                    KinematicCar(Steered(setup), reference, start));
}

}  // namespace trackbed
