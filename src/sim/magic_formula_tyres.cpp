#include "src/sim/magic_formula_tyres.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "src/sim/car_parts.h"
#include "src/sim/joint_forces.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Speed above which a tyre behaves as a rolling tyre [m/s]. Below this speed, the tyre model
/// gradually changes into a spring.
constexpr double kWalkingPace = 1.5;
/// Speed above which the full rolling resistance acts [m/s]. If the full rolling resistance acted
/// down to standstill, it would be dry friction, which needs the constraint solver.
constexpr double kRollingSpeed = 0.2;

std::size_t AxleIndex(std::size_t wheel) {
  return wheel < 2 ? 0 : 1;
}

/// Solves sigma s' = slip_speed - speed s exactly over one timestep, for the longitudinal and
/// lateral slip s of a wheel.
class Relaxation {
 public:
  Relaxation(double speed, double sigma, double timestep)
      : speed_(speed), sigma_(sigma), decay_(-std::expm1(-speed * timestep / sigma)) {
    const double x = speed * timestep / sigma;
    gain_ = timestep / sigma * (x > 1e-9 ? decay_ / x : 1.0);
  }

  /// Advances the slip `s` by one timestep and returns s + tau s'.
  [[nodiscard]] double Step(double& s, double slip_speed, double tau) const {
    s += gain_ * slip_speed - decay_ * s;
    return s + tau / sigma_ * (slip_speed - speed_ * s);
  }

 private:
  double speed_;
  double sigma_;
  double decay_;  // Fraction by which the slip decays during one step.
  double gain_;   // Increase of the slip during one step, per unit of slip speed [s/m].
};

/// Returns the value of tau that critically damps an oscillation of angular frequency `omega`.
/// Consider a mass on a spring with damping tau, integrated with timestep dt, and let W = omega dt.
/// The eigenvalues of a step solve
///   l^2 - (2 - W^2 - W omega tau) l + 1 - W omega tau = 0.
/// With omega tau = 2 - W, both eigenvalues are 1 - W. For W > 1, tau is chosen such that omega tau
/// = 1/W, which yields the eigenvalues 0 and 1 - W^2.
double Damping(double omega, double timestep) {
  const double step = omega * timestep;
  return (step < 1.0 ? 2.0 - step : 1.0 / step) / omega;
}

/// Returns the relaxation length of the slip ratio [m].
double LongitudinalRelaxation(const MagicFormula& tyre) {
  return tyre.relaxation_length_x > 0.0 ? tyre.relaxation_length_x : tyre.relaxation_length;
}

/// Returns the natural angular frequency of a wheel's rotation against its tyre's stiffness at a
/// given load, R sqrt(C_kappa/(sigma I)) [rad/s].
double SpinFrequency(const MagicFormula& tyre, double load, double radius, double inertia) {
  return radius * std::sqrt(SlipStiffness(tyre, load) / (LongitudinalRelaxation(tyre) * inertia));
}

/// Returns the slip at which the whole contact patch slides, equal to 3 mu F_z/C in the brush
/// model.
double SlidingSlip(double friction, double load, double stiffness) {
  return 3.0 * friction * load / stiffness;
}

}  // namespace

MagicFormulaTyres::MagicFormulaTyres(const CarModel& car, const mjModel& model)
    : car_(car), timestep_(model.opt.timestep), gravity_(std::abs(model.opt.gravity[2])) {
  static_cast<void>(RequireTyres(car, "tyre: magic_formula"));
  const VehicleParams& params = car.params();
  const double weight = params.mass * gravity_;
  CheckTimestep(car, weight, model);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double arm = AxleIndex(w) == 0 ? params.cg_to_rear : params.cg_to_front();
    load_at_rest_[w] = 0.5 * weight * arm / params.wheelbase;
    shape_[w] = TyreShape(model, car.parts().tyre[w]);
  }
}

/// Checks that the numerical integration of the tyres is stable. The rotation of a wheel against
/// its tyre's stiffness is stable up to omega dt = sqrt(2); the check assumes that one wheel
/// carries the load of the whole axle. The vertical motion of a wheel of mass m, on a tyre of
/// stiffness k and damping c, is stable up to k/m dt^2 + 2 c/m dt = 4.
void MagicFormulaTyres::CheckTimestep(const CarModel& car, double weight,
                                      const mjModel& model) const {
  const VehicleParams& params = car.params();
  double fastest = 0.0;  // [rad/s]
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double arm = AxleIndex(w) == 0 ? params.cg_to_rear : params.cg_to_front();
    fastest = std::max(fastest, SpinFrequency(car.parts().tyres->axle[AxleIndex(w)],
                                              weight * arm / params.wheelbase, params.wheel_radius,
                                              car.parts().spin_inertia[w]));
  }
  const auto check = [&](double longest, const char* motion) {
    if (timestep_ > longest) {
      throw InputError(
          Problem{.key = "drive.timestep",
                  .message = fmt::format("{:.4g} s is too long for the tyres of {}: {} would be "
                                         "unstable; must be at most {:.4g} s",
                                         timestep_, car.file(), motion, longest)});
    }
  };
  check(std::sqrt(2.0) / fastest, "wheel spin");
  const CarTyres& tyres = *car.parts().tyres;
  double lightest = car.params().mass;  // smallest unsprung mass of the four wheels [kg]
  for (const int carrier : car.parts().carrier) {
    lightest = std::min(lightest, model.body_subtreemass[carrier]);
  }
  const double damping = tyres.vertical_damping / lightest;
  check(4.0 / (damping + std::sqrt(damping * damping + 4.0 * tyres.vertical_stiffness / lightest)),
        "wheel hop");
}

double MagicFormulaTyres::Travel(const mjData& data, std::size_t w) const {
  const CarParts& parts = car_.parts();
  const Eigen::Map<const Eigen::Vector3d> hub(data.xpos + 3 * parts.wheel[w]);
  const Eigen::Map<const Eigen::Vector3d> chassis(data.xpos + 3 * parts.chassis);
  const mjtNum* rotation = data.xmat + 9 * parts.chassis;
  const Eigen::Vector3d up(rotation[2], rotation[5], rotation[8]);
  return up.dot(hub - chassis) - parts.hub_height[w];
}

TyreTouch MagicFormulaTyres::Touch(const mjData& data, std::size_t w) const {
  const int geom = car_.parts().tyre[w];
  return shape_[w].On(
      car_.scene().ground, Eigen::Vector3d(data.geom_xpos + 3 * geom),
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom));
}

double MagicFormulaTyres::Load(std::size_t w, double gap, double opening) const {
  const CarTyres& tyres = *car_.parts().tyres;
  const double pressed = load_at_rest_[w] - tyres.vertical_stiffness * gap;
  // The total force is limited to 0 or more: damping must not pull a lifting tyre toward the road
  // or load a tyre in the air.
  return pressed <= 0.0 ? 0.0 : std::max(0.0, pressed - tyres.vertical_damping * opening);
}

void MagicFormulaTyres::Stand(const mjData& data) {
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    slips_[w] = {};
    states_[w] = {.normal_force = Load(w, Touch(data, w).gap, 0.0)};
  }
}

void MagicFormulaTyres::TakeLateralSlip(const mjModel& model, const mjData& data) {
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const TyreTouch touch = Touch(data, w);
    const Eigen::Vector3d on_road = touch.lowest_W - touch.gap * touch.normal_W;
    const WheelContact contact = ContactAt(car_, model, data, w, on_road, touch.normal_W);
    const double speed = std::abs(contact.rolling_speed);
    slips_[w].y = speed > kAtRestSpeed ? contact.slip_speed_y / speed : 0.0;
  }
}

void MagicFormulaTyres::Apply(const mjModel& model, mjData& data,
                              const std::array<double, 4>& road) {
  const double radius = car_.params().wheel_radius;
  const CarTyres& tyres = *car_.parts().tyres;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const TyreTouch touch = Touch(data, w);
    const Eigen::Vector3d on_road = touch.lowest_W - touch.gap * touch.normal_W;
    const WheelContact contact = ContactAt(car_, model, data, w, on_road, touch.normal_W);
    const Eigen::Map<const Eigen::Vector3d> hub(data.xipos + 3 * car_.parts().wheel[w]);
    const double opening = touch.normal_W.dot(contact.hub_velocity +
                                              contact.angular_velocity.cross(touch.lowest_W - hub));
    const MagicFormula& tyre = tyres.axle[AxleIndex(w)];
    Slip& slip = slips_[w];
    WheelState& state = states_[w];
    const double load = Load(w, touch.gap, opening);
    const double speed = std::abs(contact.rolling_speed);
    state = {.normal_force = load};
    if (load <= 0.0) {
      slip = {};
      contact_[w].rolling_speed = contact.rolling_speed;
      continue;
    }

    const double sigma_x = LongitudinalRelaxation(tyre);
    const double sigma_y = tyre.relaxation_length;
    const double c_kappa = SlipStiffness(tyre, load);
    const double c_alpha = CorneringStiffness(tyre, load);
    const double spin_omega = SpinFrequency(tyre, load, radius, car_.parts().spin_inertia[w]);
    const double side_omega = std::sqrt(c_alpha * gravity_ / (sigma_y * load));
    // tau_x is limited to the time constant of the slip, sigma_x/speed.
    const double damping = Damping(spin_omega, timestep_);
    const double tau_x = speed * damping > sigma_x ? sigma_x / speed : damping;
    const double tau_y =
        speed < kWalkingPace ? Damping(side_omega, timestep_) * (1.0 - speed / kWalkingPace) : 0.0;
    const Relaxation along(speed, sigma_x, timestep_);
    const double kappa = along.Step(slip.x, contact.slip_speed_x, tau_x);
    // Most tyres have one relaxation length, for which the exponential function is evaluated once.
    const Relaxation across = sigma_x == sigma_y ? along : Relaxation(speed, sigma_y, timestep_);
    const double tangent = across.Step(slip.y, contact.slip_speed_y, tau_y);
    // Limits the slip to the largest deflection that friction can hold; otherwise a larger
    // deflection would remain when the tyre stops sliding.
    const double most_x = SlidingSlip(road[w] * tyre.p_dx1, load, c_kappa) + speed / kWalkingPace;
    const double most_y = SlidingSlip(road[w] * tyre.p_dy1, load, c_alpha) + speed / kWalkingPace;
    slip.x = std::clamp(slip.x, -most_x, most_x);
    slip.y = std::clamp(slip.y, -most_y, most_y);

    // The left and right tyres of an axle are mirror images. The Magic Formula coefficients
    // describe the left tyre, so the signs are reversed for the right tyre.
    const double side = w % 2 == 0 ? 1.0 : -1.0;
    const double lean = -std::asin(std::clamp(contact.spin_axis.dot(contact.up), -1.0, 1.0));
    const double travel = Travel(data, w);
    const double camber = lean + side * tyres.camber_gain[AxleIndex(w)] * travel;
    const TyreForce force =
        EvaluateTyreForce(tyre, load, road[w],
                          {.ratio = kappa,
                           .angle = side * std::atan(tangent),
                           .camber = side * camber,
                           .shift = std::clamp(contact.rolling_speed / kWalkingPace, -1.0, 1.0)});
    state.longitudinal_force = force.longitudinal;
    state.lateral_force = side * force.lateral;
    contact_[w] = {
        .road = road[w], .camber = side * camber, .rolling_speed = contact.rolling_speed};

    const double rolling = tyre.rolling_resistance * load * radius *
                           std::clamp(contact.spin * radius / kRollingSpeed, -1.0, 1.0);
    const Eigen::Vector3d push = load * contact.up + state.longitudinal_force * contact.forward +
                                 state.lateral_force * contact.left;
    // The added moment makes the longitudinal force act with the lever arm R about the spin axis,
    // whatever the height of the hub. With another lever arm, the road would do work on a wheel
    // that has no slip.
    const double arm = contact.up.dot(hub - contact.point);
    const Eigen::Vector3d moment =
        -(rolling + state.longitudinal_force * (radius - arm)) * contact.spin_axis;
    AddForce(model, data, car_.parts().wheel[w], contact.point, push, moment);
  }
}

std::array<WheelState, 4> MagicFormulaTyres::Observe() const {
  std::array<WheelState, 4> wheels = states_;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    wheels[w].slip_ratio = slips_[w].x;
    wheels[w].slip_angle = std::atan(slips_[w].y);
    wheels[w].friction_use = FrictionUse(
        car_.parts().tyres->axle[AxleIndex(w)], wheels[w].normal_force, contact_[w].road,
        contact_[w].camber, {wheels[w].longitudinal_force, wheels[w].lateral_force});
  }
  return wheels;
}

WheelMotion MagicFormulaTyres::Motion(std::size_t wheel) const {
  return {.rolling_speed = contact_[wheel].rolling_speed,
          .load = states_[wheel].normal_force,
          .longitudinal_force = states_[wheel].longitudinal_force};
}

double MagicFormulaTyres::RollingMoment() const {
  double sum = 0.0;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    sum += car_.parts().tyres->axle[AxleIndex(w)].rolling_resistance * states_[w].normal_force *
           car_.params().wheel_radius;
  }
  return sum;
}

}  // namespace trackbed
