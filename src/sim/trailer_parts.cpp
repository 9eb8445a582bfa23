#include "src/sim/trailer_parts.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

int Named(const mjModel& model, int type, const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  TRACKBED_CHECK(id >= 0, "the trailer has no '{}'", name);
  return id;
}

}  // namespace

std::optional<TrailerParts> FindTrailer(const mjModel& model) {
  TrailerParts parts;
  std::array<double, 13> numbers{};
  const int numeric = mj_name2id(&model, mjOBJ_NUMERIC, kTrailerNumeric);
  parts.body = mj_name2id(&model, mjOBJ_BODY, kTrailerBody);
  if (parts.body < 0 || numeric < 0 ||
      model.numeric_size[numeric] != static_cast<int>(numbers.size())) {
    return std::nullopt;
  }
  std::copy_n(model.numeric_data + model.numeric_adr[numeric], numbers.size(), numbers.begin());
  parts.params = TrailerFromNumbers(numbers);
  for (std::size_t i = 0; i < kHitchJoints.size(); ++i) {
    const int joint = Named(model, mjOBJ_JOINT, kHitchJoints[i]);
    parts.hitch_qpos[i] = model.jnt_qposadr[joint];
    parts.hitch_dof[i] = model.jnt_dofadr[joint];
  }
  for (std::size_t w = 0; w < kTrailerSides.size(); ++w) {
    const std::string side = kTrailerSides[w];
    parts.tyre[w] = Named(model, mjOBJ_GEOM, "tyre_" + side);
    const int spin = Named(model, mjOBJ_JOINT, "spin_" + side);
    parts.spin_qpos[w] = model.jnt_qposadr[spin];
    parts.spin_dof[w] = model.jnt_dofadr[spin];
    parts.wheel[w] = model.jnt_bodyid[spin];
    parts.carrier[w] = model.body_parentid[parts.wheel[w]];
    const mjtNum* inertia = model.body_inertia + 3 * parts.wheel[w];
    parts.spin_inertia[w] = *std::max_element(inertia, inertia + 3);
  }
  double height = 0.0;
  for (int body = parts.wheel[0]; body != model.body_parentid[parts.body];
       body = model.body_parentid[body]) {
    height += model.body_pos[3 * body + 2];
  }
  parts.hub_height = height;
  return parts;
}

bool IsOfTrailer(const mjModel& model, const TrailerParts& trailer, int body) {
  while (body > 0 && body != trailer.body) {
    body = model.body_parentid[body];
  }
  return body == trailer.body;
}

double RollingMass(const TrailerParts& trailer) {
  const double radius = trailer.params.wheel_radius;
  return trailer.params.mass +
         (trailer.spin_inertia[0] + trailer.spin_inertia[1]) / (radius * radius);
}

double TrailerClimb(const TrailerParams& trailer, const Ground& ground, const Pose2& car,
                    double angle) {
  const Pose2 axle = TrailerPose(trailer, car, angle);
  const double rise = GroundSlope(ground, axle.position()).dot(Direction(axle.yaw));
  return trailer.mass * rise / std::hypot(1.0, rise);
}

std::array<double, 2> NoseLoads(const TrailerParams& trailer, double wheelbase, double gravity) {
  const double nose = trailer.mass * gravity * trailer.nose_share();
  const double front = -nose * trailer.hitch / wheelbase;
  return {front, nose - front};
}

}  // namespace trackbed
