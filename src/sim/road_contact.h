#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "src/sim/tyre_shape.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Returns the conaffinity bit of the plane under a wheel. Car models do not use the bits of the
/// planes.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (24 + wheel);
}

/// How the tyres are supported by the ground.
enum class TyreSupport {
  kContacts,  ///< MuJoCo's contacts carry the tyres.
  kSprings,   ///< The springs of MagicFormulaTyres carry the tyres.
};

/// Lets tyres roll on the ground itself, not on the facets of its height fields.
///
/// In MuJoCo, a height field consists of prisms with flat facets, and a rigid tyre bounces from
/// facet to facet. On a hump of 8 m length and 0.1 m height at 10 m/s, wheel loads jump by 832 N
/// from one step of 2 ms to the next, compared with 7 N on the exact ground. On the facets, the car
/// also loses twice as much speed. RoadContact lets each tyre touch a single plane (`ground_fl`,
/// …). Before every step, the plane is moved to be tangent to the exact ground under the tyre.
/// Contacts, friction and forces are still computed by MuJoCo.
///
/// With TyreSupport::kSprings, MuJoCo computes no contacts between tyres and ground.
class RoadContact {
 public:
  /// Prepares `model`, a copy of the car's model: the tyres touch their planes (or nothing) instead
  /// of the ground, and still touch all other geoms as before. If the ground is a single plane, its
  /// contacts with the tyres stay unchanged.
  RoadContact(const CarModel& car, TyreSupport support, mjModel& model);

  /// Places the planes for the coming step, from the state in `data`. Place() also updates the body
  /// poses in `data`.
  void Place(mjModel& model, mjData& data) const;

 private:
  const CarModel& car_;
  bool has_planes_;
  std::array<int, 4> plane_{};  // index of the plane geom under each wheel
  std::array<TyreShape, 4> shape_;
};

}  // namespace trackbed
