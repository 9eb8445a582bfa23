#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "src/sim/tyre_shape.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The bit of conaffinity of the plane under a wheel, of those that cars have no use for.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (24 + wheel);
}

/// What holds the tyres up.
enum class TyreSupport {
  kContacts,  ///< MuJoCo's
  kSprings,   ///< MagicFormulaTyres
};

/// Lets tyres roll on the ground itself, not on the facets of its height fields.
///
/// MuJoCo touches a height field prism by prism. A tyre as stiff as a wheel's is thrown from facet
/// to facet: loads jump by 832 N from one step of 2 ms to the next on a hump of 8 m and 0.1 m at 10
/// m/s, where they change by 7 N on the ground itself, and a car loses twice the speed. Here each
/// tyre touches one plane, `ground_fl` and so on, that is laid tangent to the ground under it
/// before every step. Contacts, friction and forces stay MuJoCo's.
///
/// With TyreSupport::kSprings tyres do not collide with the ground.
class RoadContact {
 public:
  /// Readies the model, a copy of the car's own: its tyres touch their planes, or nothing, in place
  /// of all other ground, and what else they touched before. Contacts on a plane stay as they are.
  RoadContact(const CarModel& car, TyreSupport support, mjModel& model);

  /// Lays the planes for the step from the state in `data`. Updates its bodies' places.
  void Place(mjModel& model, mjData& data) const;

 private:
  const CarModel& car_;
  bool has_planes_;
  std::array<int, 4> plane_{};  // geom
  std::array<TyreShape, 4> shape_;
};

}  // namespace trackbed
