#include "src/sim/wheel_contacts.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "src/sim/contact_friction.h"

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

/// Calls `call` for each contact of a wheel with the road; the arguments are the wheel, the
/// contact, the contact's index, and a sign. MuJoCo's contact force acts on the second geom of the
/// contact; multiplied by the sign, it is the force on the wheel.
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

WheelContact ContactAt(const CarModel& car, const mjModel& model, const mjData& data, std::size_t w,
                       const Vector3d& point, const Vector3d& up) {
  return ContactAt(model, data, car.parts().wheel[w], car.params().wheel_radius, point, up);
}

WheelContact ContactAt(const mjModel& model, const mjData& data, int body, double radius,
                       const Vector3d& point, const Vector3d& up) {
  const mjtNum* rotation = data.xmat + 9 * body;
  std::array<mjtNum, 6> velocity{};  // components of the spatial velocity: angular velocity, then
                                     // linear velocity
  mj_objectVelocity(&model, &data, mjOBJ_BODY, body, velocity.data(), 0);
  WheelContact wheel;
  wheel.touches = true;
  wheel.point = point;
  wheel.up = up;
  wheel.spin_axis = Vector3d(rotation[1], rotation[4], rotation[7]);
  wheel.forward = wheel.spin_axis.cross(up).normalized();
  wheel.left = up.cross(wheel.forward);
  wheel.angular_velocity = Vec(velocity.data());
  wheel.hub_velocity = Vec(velocity.data() + 3);
  wheel.rolling_speed = wheel.forward.dot(wheel.hub_velocity);
  wheel.spin = wheel.angular_velocity.dot(wheel.spin_axis);
  wheel.slip_speed_x = wheel.spin * radius - wheel.rolling_speed;
  wheel.slip_speed_y =
      wheel.left.dot(wheel.hub_velocity + wheel.angular_velocity.cross(-radius * up));
  return wheel;
}

std::array<WheelContact, 4> FindWheelContacts(const CarModel& car, const mjModel& model,
                                              const mjData& data) {
  std::array<Vector3d, 4> up;
  std::array<Vector3d, 4> point;
  up.fill(Vector3d::Zero());
  point.fill(Vector3d::Zero());
  std::array<double, 4> weight{};
  // On a rough road, a wheel may have several contact points. The position of a wheel's contact is
  // the mean of its contact points, weighted by penetration depth.
  ForEachRoadContact(car, model, data,
                     [&](std::size_t w, const mjContact& contact, int, double sign) {
                       const double depth = std::max(contact.includemargin - contact.dist, 1e-9);
                       up[w] += depth * sign * Vec(contact.frame);
                       point[w] += depth * Vec(contact.pos);
                       weight[w] += depth;
                     });
  std::array<WheelContact, 4> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const bool touches = weight[w] > 0.0;
    const Vector3d hub = Vec(data.xipos + 3 * car.parts().wheel[w]);
    wheels[w] =
        touches ? ContactAt(car, model, data, w, point[w] / weight[w], up[w].normalized())
                : ContactAt(car, model, data, w,
                            hub - car.params().wheel_radius * Vector3d::UnitZ(), Vector3d::UnitZ());
    wheels[w].touches = touches;
  }
  return wheels;
}

std::array<Vector3d, 4> RoadForces(const CarModel& car, const mjModel& model, const mjData& data) {
  std::array<Vector3d, 4> forces;
  forces.fill(Vector3d::Zero());
  ForEachRoadContact(
      car, model, data, [&](std::size_t w, const mjContact& contact, int i, double sign) {
        std::array<mjtNum, 6> force{};
        mj_contactForce(&model, &data, i, force.data());
        // the rows of the frame matrix are the axes along which MuJoCo states the contact force
        for (int axis = 0; axis < 3; ++axis) {
          forces[w] += sign * force[static_cast<std::size_t>(axis)] * Vec(contact.frame + 3 * axis);
        }
      });
  return forces;
}

std::array<WheelState, 4> ContactWheelStates(const CarModel& car, const mjModel& model,
                                             const mjData& data) {
  const auto forces = RoadForces(car, model, data);
  const auto contacts = FindWheelContacts(car, model, data);
  std::array<WheelState, 4> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const WheelContact& contact = contacts[w];
    // Slip is the slip speed divided by the rolling speed; if the wheel rolls more slowly than the
    // standstill threshold, by this threshold.
    const double reference = std::max(std::abs(contact.rolling_speed), kAtRestSpeed);
    wheels[w] = {.normal_force = std::max(0.0, contact.up.dot(forces[w])),
                 .longitudinal_force = contact.forward.dot(forces[w]),
                 .lateral_force = contact.left.dot(forces[w]),
                 .slip_angle = std::atan2(contact.slip_speed_y, reference),
                 .slip_ratio = contact.slip_speed_x / reference};
    // MujocoPlant has multiplied the friction coefficient of the tyre's geom by the road's friction
    // factor.
    const double most = ContactFriction(model, car.parts().tyre[w]) * wheels[w].normal_force;
    wheels[w].friction_use =
        most > 0.0 ? std::hypot(wheels[w].longitudinal_force, wheels[w].lateral_force) / most : 0.0;
  }
  return wheels;
}

}  // namespace trackbed
