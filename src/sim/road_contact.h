#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// The bit of conaffinity of the plane under a wheel, of those that cars have no use for.
constexpr int WheelPlaneBit(std::size_t wheel) {
  return 1 << (24 + wheel);
}

/// Lets tyres roll on the ground itself, not on the facets of its height fields.
///
/// MuJoCo touches a height field prism by prism. A tyre as stiff as a wheel's is thrown from facet
/// to facet: loads jump by 832 N from one step of 2 ms to the next on a hump of 8 m and 0.1 m at 10
/// m/s, where they change by 7 N on the ground itself, and a car loses twice the speed. Here each
/// tyre touches one plane, `ground_fl` and so on, that is laid tangent to the ground under it
/// before every step. Contacts, friction and forces stay MuJoCo's.
///
/// Exact for ground that bends less than a tyre does; where it bends up more, a real tyre touches
/// at two places, this one at one.
class RoadContact {
 public:
  /// Readies the model, a copy of the car's own: its tyres touch their planes in place of all other
  /// ground, and what else they touched before. On ground without bumps and side slopes, nothing.
  RoadContact(const CarModel& car, mjModel& model);

  /// Lays the planes for the step from the state in `data`. Updates its bodies' places.
  void Place(mjModel& model, mjData& data) const;

 private:
  /// Where a tyre would touch the ground.
  struct Touch {
    Eigen::Vector3d lowest_W;  ///< the point of the tyre farthest against the ground's normal
    Eigen::Vector3d normal_W;
    double gap;  ///< from the ground to that point along the normal [m]
  };

  [[nodiscard]] Touch Find(std::size_t wheel, const Eigen::Vector3d& center_W,
                           const Eigen::Matrix3d& R_WT) const;

  const CarModel& car_;
  bool curved_;
  std::array<int, 4> plane_{};                 // geom
  std::array<Eigen::Vector3d, 4> half_axes_T;  // of the tyre's ellipsoid
};

}  // namespace trackbed
