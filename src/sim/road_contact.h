#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "src/sim/tyre_shape.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The conaffinity bit of the plane under a wheel. Models of cars do not use the bits of the
/// planes.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (24 + wheel);
}

/// The way in which the tyres are supported.
enum class TyreSupport {
  kContacts,  ///< Support by MuJoCo's contacts.
  kSprings,   ///< Support by MagicFormulaTyres.
};

/// Lets tyres roll on the ground itself, not on the facets of its height fields.
///
/// MuJoCo collides with a height field prism by prism. A tyre as stiff as a wheel is thrown from
/// facet to facet. On a hump of 8 m and 0.1 m at 10 m/s, loads jump by 832 N from one step of 2 ms
/// to the next, against 7 N on the exact ground. On the facets of the hump, the car loses twice the
/// speed. RoadContact lets each tyre touch one plane, `ground_fl` and so on. Before every step, the
/// plane is laid tangent to the ground under the tyre. Contacts, friction and forces remain those
/// of MuJoCo.
///
/// With TyreSupport::kSprings, tyres do not collide with the ground.
class RoadContact {
 public:
  /// Prepares `model`, a copy of the car's model. The tyres touch their planes (or nothing) instead
  /// of the ground. The tyres still touch everything else that they touched before. Contacts of
  /// tyres with a ground that is a plane stay as they are.
  RoadContact(const CarModel& car, TyreSupport support, mjModel& model);

  /// Places the planes for the step from the state in `data`. Place() updates the poses of the
  /// bodies in `data`.
  void Place(mjModel& model, mjData& data) const;

 private:
  const CarModel& car_;
  bool has_planes_;
  std::array<int, 4> plane_{};  // geom of the plane under each wheel
  std::array<TyreShape, 4> shape_;
};

}  // namespace trackbed
