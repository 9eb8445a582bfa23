#include "src/sim/magic_formula_tyres.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "src/sim/car_parts.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Above this a tyre rolls as it does at any speed; below, it turns into a spring [m/s].
constexpr double kWalkingPace = 1.5;
/// Speed at which rolling resistance is fully there [m/s]; less would be a dry friction that only
/// the solver could hold.
constexpr double kRolls = 0.2;

std::size_t AxleIndex(std::size_t wheel) {
  return wheel < 2 ? 0 : 1;
}

/// One timestep of sigma s' = slip_speed - speed s, exactly; then s + tau s'.
double Relax(double& s, double slip_speed, double speed, double sigma, double tau,
             double timestep) {
  const double x = speed * timestep / sigma;
  const double grown = x > 1e-9 ? -std::expm1(-x) / x : 1.0;
  s = s * std::exp(-x) + slip_speed * timestep / sigma * grown;
  return s + tau / sigma * (slip_speed - speed * s);
}

/// tau that damps an oscillation of angular frequency `omega` critically. In steps of W = omega dt,
/// a mass on a spring damped by tau has the eigenvalues of
///   l^2 - (2 - W^2 - W omega tau) l + 1 - W omega tau = 0,
/// both 1 - W with omega tau = 2 - W. Beyond W = 1, 1/W leaves the larger one at 1 - W^2.
double Damping(double omega, double timestep) {
  const double step = omega * timestep;
  return (step < 1.0 ? 2.0 - step : 1.0 / step) / omega;
}

/// omega [rad/s] at which a wheel's spin swings on its tyre at a load: R sqrt(C_kappa/(sigma I)).
double SpinFrequency(const MagicFormula& tyre, double load, double radius, double inertia) {
  return radius * std::sqrt(SlipStiffness(tyre, load) / (tyre.relaxation_length * inertia));
}

/// Slip beyond which a tyre slides all over; 3 mu F_z/C, as in the brush model.
double SlidingSlip(double friction, double load, double stiffness) {
  return 3.0 * friction * load / stiffness;
}

}  // namespace

MagicFormulaTyres::MagicFormulaTyres(const CarModel& car, mjModel& model)
    : car_(car), timestep_(model.opt.timestep), gravity_(std::abs(model.opt.gravity[2])) {
  const CarTyres& tyres = RequireTyres(car, "tyre: magic_formula");
  const VehicleParams& params = car.params();
  const double weight = params.mass * gravity_;
  CheckTimestep(car, weight);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const int geom = car.parts().tyre[w];
    model.geom_condim[geom] = 1;
    if (tyres.vertical_stiffness > 0.0) {
      // A contact whose impedance d is constant is a spring of stiffness k/((1 - d) A) with A the
      // inverse inertia that MuJoCo reckons with; a small d leaves the wheel's own mass alone. It
      // begins above the road by what the car's weight presses it in, so that it stands as it did.
      constexpr double kImpedance = 0.05;
      const double inverse_inertia = model.body_invweight0[2 * car.parts().wheel[w]];
      const double scale = (1.0 - kImpedance) * inverse_inertia;
      mjtNum* solref = model.geom_solref + mjNREF * geom;
      solref[0] = -tyres.vertical_stiffness * scale;
      solref[1] = -std::max(tyres.vertical_damping, mjMINVAL) * scale;
      mjtNum* solimp = model.geom_solimp + mjNIMP * geom;
      solimp[0] = kImpedance;
      solimp[1] = kImpedance;
      const double arm = AxleIndex(w) == 0 ? params.cg_to_rear : params.cg_to_front();
      const double load = 0.5 * weight * arm / params.wheelbase;
      model.geom_margin[geom] = load / tyres.vertical_stiffness;
    }
  }
}

/// Damping keeps a wheel's spin on its tyre stable up to omega dt = sqrt(2), with all that an axle
/// carries on one of its wheels.
void MagicFormulaTyres::CheckTimestep(const CarModel& car, double weight) const {
  const VehicleParams& params = car.params();
  double fastest = 0.0;  // [rad/s]
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const double arm = AxleIndex(w) == 0 ? params.cg_to_rear : params.cg_to_front();
    fastest = std::max(fastest, SpinFrequency(car.parts().tyres->axle[AxleIndex(w)],
                                              weight * arm / params.wheelbase, params.wheel_radius,
                                              car.parts().spin_inertia[w]));
  }
  const double longest = std::sqrt(2.0) / fastest;
  if (timestep_ > longest) {
    throw InputError(
        Problem{.key = "drive.timestep",
                .message = fmt::format("{:.4g} s is too long for the tyres of {}: wheel spin would "
                                       "be unstable; must be at most {:.4g} s",
                                       timestep_, car.file(), longest)});
  }
}

double MagicFormulaTyres::Travel(const mjData& data, std::size_t w) const {
  const CarParts& parts = car_.parts();
  const Eigen::Map<const Eigen::Vector3d> hub(data.xpos + 3 * parts.wheel[w]);
  const Eigen::Map<const Eigen::Vector3d> chassis(data.xpos + 3 * parts.chassis);
  const mjtNum* rotation = data.xmat + 9 * parts.chassis;
  const Eigen::Vector3d up(rotation[2], rotation[5], rotation[8]);
  return up.dot(hub - chassis) - parts.hub_height[w];
}

void MagicFormulaTyres::Stand(const std::array<double, 4>& loads) {
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    slips_[w] = {};
    states_[w] = {.normal_force = loads[w]};
  }
}

void MagicFormulaTyres::Apply(const mjModel& model, mjData& data,
                              const std::array<double, 4>& loads,
                              const std::array<double, 4>& road) {
  const double radius = car_.params().wheel_radius;
  const auto contacts = FindWheelContacts(car_, model, data);
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const WheelContact& contact = contacts[w];
    const CarTyres& tyres = *car_.parts().tyres;
    const MagicFormula& tyre = tyres.axle[AxleIndex(w)];
    Slip& slip = slips_[w];
    WheelState& state = states_[w];
    const double load = contact.touches ? loads[w] : 0.0;
    const double speed = std::abs(contact.rolling_speed);
    state = {.normal_force = load};
    if (load <= 0.0) {
      slip = {};
      continue;
    }

    const double sigma = tyre.relaxation_length;
    const double c_kappa = SlipStiffness(tyre, load);
    const double c_alpha = CorneringStiffness(tyre, load);
    const double spin_omega = SpinFrequency(tyre, load, radius, car_.parts().spin_inertia[w]);
    const double side_omega = std::sqrt(c_alpha * gravity_ / (sigma * load));
    // Where the slip follows faster than the damping wants, the damping must not run ahead of it.
    const double tau_x = speed * Damping(spin_omega, timestep_) > sigma
                             ? sigma / speed
                             : Damping(spin_omega, timestep_);
    const double tau_y = Damping(side_omega, timestep_) * std::max(0.0, 1.0 - speed / kWalkingPace);
    double kappa = Relax(slip.x, contact.slip_speed_x, speed, sigma, tau_x, timestep_);
    double tangent = Relax(slip.y, contact.slip_speed_y, speed, sigma, tau_y, timestep_);
    // A tyre that comes to rest sliding keeps no more deflection than it can hold.
    const double most_x = SlidingSlip(road[w] * tyre.p_dx1, load, c_kappa) + speed / kWalkingPace;
    const double most_y = SlidingSlip(road[w] * tyre.p_dy1, load, c_alpha) + speed / kWalkingPace;
    slip.x = std::clamp(slip.x, -most_x, most_x);
    slip.y = std::clamp(slip.y, -most_y, most_y);

    // Left and right tyres are mirror images, so the law's asymmetries are the left one's.
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
    state.slip_ratio = slip.x;
    state.slip_angle = std::atan(slip.y);

    const double rolling = tyre.rolling_resistance * load * radius *
                           std::clamp(contact.spin * radius / kRolls, -1.0, 1.0);
    const Eigen::Vector3d push =
        state.longitudinal_force * contact.forward + state.lateral_force * contact.left;
    const Eigen::Vector3d moment = -rolling * contact.spin_axis;
    mj_applyFT(&model, &data, push.data(), moment.data(), contact.point.data(),
               car_.parts().wheel[w], data.qfrc_applied);
  }
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
