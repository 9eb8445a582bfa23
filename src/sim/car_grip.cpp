#include "trackbed/sim/car_grip.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "src/sim/contact_friction.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

/// Returns the slide joint between a wheel and the chassis; -1 if there is no such joint.
int SpringJoint(const mjModel& model, int wheel, int chassis) {
  for (int body = wheel; body > 0 && body != chassis; body = model.body_parentid[body]) {
    for (int i = 0; i < model.body_jntnum[body]; ++i) {
      const int joint = model.body_jntadr[body] + i;
      if (model.jnt_type[joint] == mjJNT_SLIDE) {
        return joint;
      }
    }
  }
  return -1;
}

/// Returns the roll stiffness of an axle's springs and anti-roll bars [N m/rad]. Without springs,
/// the roll stiffness is infinite, because the wheels are fixed to the chassis or rest on the stops
/// of their joints. To compute the roll stiffness, the left wheel is moved up by z and the right
/// wheel down by z, so the roll angle is 2 z/track.
double SuspensionStiffness(const mjModel& model, int left, int right, double track) {
  if (left < 0 || right < 0) {
    return std::numeric_limits<double>::infinity();
  }
  double stiffness = model.jnt_stiffness[left] + model.jnt_stiffness[right];  // d^2E/dz^2
  for (int tendon = 0; tendon < model.ntendon; ++tendon) {
    double coefficient = 0.0;
    for (int i = 0; i < model.tendon_num[tendon]; ++i) {
      const int wrap = model.tendon_adr[tendon] + i;
      if (model.wrap_type[wrap] == mjWRAP_JOINT) {
        const int joint = model.wrap_objid[wrap];
        coefficient += joint == left    ? model.wrap_prm[wrap]
                       : joint == right ? -model.wrap_prm[wrap]
                                        : 0.0;
      }
    }
    stiffness += model.tendon_stiffness[tendon] * coefficient * coefficient;
  }
  return stiffness > 0.0 ? 0.25 * stiffness * track * track
                         : std::numeric_limits<double>::infinity();
}

LongitudinalForces Forces(const CarModel& car) {
  const VehicleParams& params = car.unladen();
  const CarParts& parts = car.parts();
  LongitudinalForces forces{.mass = params.mass,
                            .drive_force = parts.drive_limit / params.wheel_radius,
                            .drive_power = parts.drive_power,
                            .drag = 0.5 * kAirDensity * parts.aerodynamics.drag_area,
                            .top_speed = params.top_speed};
  forces.brake_force =
      2.0 * (parts.brake_torque_front + parts.brake_torque_rear) / params.wheel_radius;
  // In VehicleParams, the limit of the braking deceleration does not include the rolling
  // resistance. In VehicleParams, the limit of the driving acceleration is that after subtracting
  // the rolling resistance.
  forces.rolling_mass = forces.brake_force / params.braking.by_force;
  forces.rolling_resistance =
      std::max(0.0, forces.drive_force - forces.rolling_mass * params.driving.by_force);
  return forces;
}

}  // namespace

GripModel MakeGripModel(const CarModel& car, TyreLaw law) {
  const VehicleParams& params = car.unladen();
  const CarParts& parts = car.parts();
  const mjModel& model = *car.get();
  GripModel grip{.forces = Forces(car),
                 .wheelbase = params.wheelbase,
                 .cg_height = params.braking.axles[0].transfer * params.wheelbase,
                 .drag_height = parts.aerodynamics.center_of_pressure[1],
                 .steering_limit = params.steering_limit};
  const bool formula = SelectTyreLaw(car, law) == TyreLaw::kMagicFormula && parts.tyres;
  constexpr double kRigid = 1e4;  // [N m/rad/kg]
  for (std::size_t i = 0; i < grip.axles.size(); ++i) {
    GripAxle& axle = grip.axles[i];
    axle.weight = params.braking.axles[i].weight;
    axle.track = i == 0 ? params.track_front : params.track_rear;
    axle.braking = params.braking.axles[i].force;
    axle.driving = params.driving.axles[i].force;
    const double springs =
        SuspensionStiffness(model, SpringJoint(model, parts.wheel[2 * i], parts.chassis),
                            SpringJoint(model, parts.wheel[2 * i + 1], parts.chassis), axle.track);
    const double tyres = formula ? 0.5 * parts.tyres->vertical_stiffness * axle.track * axle.track
                                 : std::numeric_limits<double>::infinity();
    const double compliance = 1.0 / springs + 1.0 / tyres;
    axle.roll_stiffness = compliance > 0.0 ? 1.0 / compliance : kRigid * params.mass;
    axle.suspension_share = axle.roll_stiffness / springs;
    if (formula) {
      axle.tyre = parts.tyres->axle[i];
      axle.camber_gain = parts.tyres->camber_gain[i];
    } else {
      axle.friction = ContactFriction(model, parts.tyre[2 * i]);
    }
  }
  return grip;
}

GgvDiagram ComputeGgv(const CarModel& car, TyreLaw law, const std::vector<double>& roads) {
  const VehicleParams& params = car.unladen();
  if (params.kind != VehicleKind::kSteered) {
    return FrictionGgv(params, roads);
  }
  const GgvDiagram diagram = ComputeGgv(MakeGripModel(car, law), roads);
  std::vector<GgvSection> sections = diagram.sections();
  for (GgvSection& section : sections) {
    const double hardest = MaxDeceleration(params, section.road);
    for (std::size_t i = 0; i < section.braking.size(); ++i) {
      section.braking[i] = std::max(section.braking[i], std::min(-hardest, section.driving[i]));
    }
  }
  return {diagram.forces(), std::move(sections)};
}

}  // namespace trackbed
