#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "src/sim/tyre_shape.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The conaffinity bit of the plane under a wheel. Models of cars do not use these bits.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (24 + wheel);
}

/// How the tyres are supported.
enum class TyreSupport {
  kContacts,  ///< by MuJoCo's contacts
  kSprings,   ///< by MagicFormulaTyres
};

/// Lets tyres roll on the ground itself, not on the facets of its height fields.
///
/// MuJoCo collides with a height field prism by prism. A tyre as stiff as a wheel is thrown from
/// facet to facet: on a hump of 8 m and 0.1 m at 10 m/s, loads jump by 832 N from one step of 2 ms
/// to the next, against 7 N on the exact ground, and a car loses twice the speed. Here each tyre
/// touches one plane, `ground_fl` and so on, that is laid tangent to the ground under it before
/// every step. Contacts, friction and forces stay MuJoCo's.
///
/// With TyreSupport::kSprings tyres do not collide with the ground.
class RoadContact {
 public:
  /// Prepares the model, a copy of the car's: its tyres touch their planes (or nothing) instead of
  /// the ground, and everything else they touched before. Contacts on a plane stay as they are.
  RoadContact(const CarModel& car, TyreSupport support, mjModel& model);

  /// Places the planes for the step from the state in `data`. Updates the poses of its bodies.
  void Place(mjModel& model, mjData& data) const;

 private:
  const CarModel& car_;
  bool has_planes_;
  std::array<int, 4> plane_{};  // geom
  std::array<TyreShape, 4> shape_;
};

}  // namespace trackbed
