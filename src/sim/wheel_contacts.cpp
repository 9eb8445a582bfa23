#include "src/sim/wheel_contacts.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string_view>

namespace trackbed {
namespace {

using Eigen::Vector3d;

Vector3d Vec(const mjtNum* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

bool IsRoad(const mjModel& model, int geom) {
  const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
  return name != nullptr && std::string_view(name).starts_with("ground");
}

/// Calls with wheel, contact, its index, and the sign that turns the contact's forces, which act on
/// its second geom, into those on the wheel.
template <typename Call>
void ForEachRoadContact(const CarModel& car, const mjModel& model, const mjData& data,
                        const Call& call) {
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      const int tyre = car.parts().tyre[w];
      const bool first = contact.geom1 == tyre;
      if ((first || contact.geom2 == tyre) &&
          IsRoad(model, first ? contact.geom2 : contact.geom1)) {
        call(w, contact, i, first ? -1.0 : 1.0);
      }
    }
  }
}

}  // namespace

std::array<WheelContact, 4> FindWheelContacts(const CarModel& car, const mjModel& model,
                                              const mjData& data) {
  const double radius = car.params().wheel_radius;
  std::array<WheelContact, 4> wheels;
  std::array<double, 4> weight{};
  for (WheelContact& wheel : wheels) {
    wheel.up.setZero();
    wheel.point.setZero();
  }
  // On a rough road a wheel may touch at several points: they count by how deep they are.
  ForEachRoadContact(car, model, data,
                     [&](std::size_t w, const mjContact& contact, int, double sign) {
                       const double depth = std::max(contact.includemargin - contact.dist, 1e-9);
                       wheels[w].up += depth * sign * Vec(contact.frame);
                       wheels[w].point += depth * Vec(contact.pos);
                       weight[w] += depth;
                     });
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    WheelContact& wheel = wheels[w];
    const int body = car.parts().wheel[w];
    const mjtNum* rotation = data.xmat + 9 * body;
    wheel.touches = weight[w] > 0.0;
    wheel.up = wheel.touches ? wheel.up.normalized() : Vector3d::UnitZ();
    const Vector3d hub = Vec(data.xipos + 3 * body);
    wheel.point =
        wheel.touches ? Vector3d(wheel.point / weight[w]) : Vector3d(hub - radius * wheel.up);
    wheel.spin_axis = Vector3d(rotation[1], rotation[4], rotation[7]);
    wheel.forward = wheel.spin_axis.cross(wheel.up).normalized();
    wheel.left = wheel.up.cross(wheel.forward);
    std::array<mjtNum, 6> velocity{};  // angular, linear
    mj_objectVelocity(&model, &data, mjOBJ_BODY, body, velocity.data(), 0);
    const Vector3d omega = Vec(velocity.data());
    const Vector3d hub_velocity = Vec(velocity.data() + 3);
    wheel.rolling_speed = wheel.forward.dot(hub_velocity);
    wheel.spin = omega.dot(wheel.spin_axis);
    wheel.slip_speed_x = wheel.spin * radius - wheel.rolling_speed;
    wheel.slip_speed_y = wheel.left.dot(hub_velocity + omega.cross(-radius * wheel.up));
  }
  return wheels;
}

std::array<double, 4> RoadLoads(const CarModel& car, const mjModel& model, const mjData& data) {
  std::array<double, 4> loads{};
  ForEachRoadContact(car, model, data, [&](std::size_t w, const mjContact&, int i, double) {
    std::array<mjtNum, 6> force{};
    mj_contactForce(&model, &data, i, force.data());
    loads[w] += force[0];  // the normal's row comes first
  });
  return loads;
}

std::array<Vector3d, 4> RoadForces(const CarModel& car, const mjModel& model, const mjData& data) {
  std::array<Vector3d, 4> forces;
  forces.fill(Vector3d::Zero());
  ForEachRoadContact(
      car, model, data, [&](std::size_t w, const mjContact& contact, int i, double sign) {
        std::array<mjtNum, 6> force{};
        mj_contactForce(&model, &data, i, force.data());
        for (int axis = 0; axis < 3; ++axis) {  // the rows of the contact's frame
          forces[w] += sign * force[static_cast<std::size_t>(axis)] * Vec(contact.frame + 3 * axis);
        }
      });
  return forces;
}

}  // namespace trackbed
