#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <vector>

#include "src/sim/tyre_shape.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Largest number of wheels of a car and its trailer together.
inline constexpr std::size_t kMaxWheels = 6;

/// Returns the collision bit (conaffinity) of the plane that is kept under a wheel. The wheel
/// indices 4 and 5 are those of a trailer. The models of cars must not use the collision bits of
/// the planes under the wheels.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (wheel < 4 ? 24 + wheel : 25 + wheel);  // bit 28 is kOtherGeomsBit
}

/// Ways in which the ground supports the tyres.
enum class TyreSupport {
  kContacts,  ///< MuJoCo's contacts support the tyres.
  kSprings,   ///< The springs of MagicFormulaTyres support the tyres.
};

/// Lets tyres roll on the exact ground instead of the flat facets of MuJoCo's height fields.
///
/// In MuJoCo, a height field consists of prisms with flat facets, and a rigid tyre bounces from
/// facet to facet. For example, a car crosses a hump of 8 m length and 0.1 m height at 10 m/s, with
/// timesteps of 2 ms. Its wheel loads jump by up to 832 N per timestep on the facets, but only by 7
/// N on the exact ground. On the facets of a height field, the car also loses twice as much speed
/// as on the exact ground. With RoadContact, each tyre touches only a single plane (`ground_fl`,
/// …). Before every step, the plane is moved to be tangent to the exact ground under the tyre.
/// MuJoCo still computes the contacts, friction and forces between tyres and planes.
///
/// With TyreSupport::kSprings, MuJoCo computes no contacts between tyres and ground.
class RoadContact {
 public:
  /// Prepares `model`, a copy of the car's model, such that the tyres touch their planes (or
  /// nothing) instead of the ground, and still touch all other geoms as before. If the ground is a
  /// single plane, its contacts with the tyres stay unchanged.
  RoadContact(const CarModel& car, TyreSupport support, mjModel& model);

  /// Places the planes under the tyres for the coming step, from the state in `data`. Place() also
  /// updates the body poses in `data`.
  void Place(mjModel& model, mjData& data) const;

 private:
  const CarModel& car_;
  bool has_planes_;
  std::vector<int> tyres_;  // Collision geoms of the wheels of the car, then of its trailer.
  // For each wheel, the index of the plane geom under the wheel.
  std::array<int, kMaxWheels> plane_{};
  std::array<TyreShape, kMaxWheels> shape_;
};

}  // namespace trackbed
