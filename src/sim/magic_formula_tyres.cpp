#include "src/sim/magic_formula_tyres.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/sim/car_parts.h"
#include "src/sim/joint_forces.h"
#include "src/sim/trailer_parts.h"
#include "trackbed/core/error.h"

// Simulates the tyres of a car by the Magic Formula with relaxation lengths.
// 1. In each step, the slips follow the speeds of the contact patch with a first-order lag over the
//    distance rolled; the class Relaxation solves the lag's equation exactly.
// 2. The tyre forces are computed from the slips, the load and the camber (magic_formula.h).
// 3. Below walking pace, a tyre becomes a spring with critical damping, so that a car can stand on
//    a slope.
// 4. The constructor checks that explicit integration of the wheels is stable with the timestep.
// Source: Pacejka 2012, chapter 7.
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

/// Solves sigma s' = slip_speed - speed s exactly over one timestep, for the longitudinal or
/// lateral slip s of a wheel with the relaxation length sigma.
class Relaxation {
 public:
  Relaxation(double speed, double sigma, double timestep)
      : speed_(speed), sigma_(sigma), decay_(-std::expm1(-speed * timestep / sigma)) {
    const double x = speed * timestep / sigma;
    gain_ = timestep / sigma * (x > 1e-9 ? decay_ / x : 1.0);
  }

  /// Advances the slip `s` by one timestep and returns s + tau s', with the damping time `tau`.
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

/// Returns the damping time tau that critically damps an oscillation of angular frequency `omega`.
/// The eigenvalues l of a step of a mass on a spring with damping tau, integrated with the timestep
/// dt, solve the following equation with W = omega dt:
///   l^2 - (2 - W^2 - W omega tau) l + 1 - W omega tau = 0.
/// For W = omega dt < 1, the damping omega tau = 2 - W makes both eigenvalues of a step equal to 1
/// - W. For W >= 1, the damping omega tau = 1/W yields the eigenvalues 0 and 1 - W^2.
double Damping(double omega, double timestep) {
  const double step = omega * timestep;
  return (step < 1.0 ? 2.0 - step : 1.0 / step) / omega;
}

/// Returns the relaxation length of the slip ratio [m].
double LongitudinalRelaxation(const MagicFormula& tyre) {
  return tyre.relaxation_length_x > 0.0 ? tyre.relaxation_length_x : tyre.relaxation_length;
}

/// Returns the natural angular frequency of a wheel's rotation against its tyre's stiffness at a
/// given load [rad/s]. This frequency is R sqrt(C_kappa/(sigma I)), with radius R, slip stiffness
/// C_kappa, relaxation length sigma and spin inertia I.
double SpinFrequency(const MagicFormula& tyre, double load, double radius, double inertia) {
  return radius * std::sqrt(SlipStiffness(tyre, load) / (LongitudinalRelaxation(tyre) * inertia));
}

/// Returns the slip at which the whole contact patch slides: 3 mu F_z/C in the brush model with the
/// slip stiffness C.
double SlidingSlip(double friction, double load, double stiffness) {
  return 3.0 * friction * load / stiffness;
}

/// Returns the contact of a wheel at the point of the road below the lowest point of the tyre.
WheelContact ContactOf(const mjModel& model, const mjData& data, const TyreWheel& wheel,
                       const TyreTouch& touch) {
  const Eigen::Vector3d on_road = touch.lowest_W - touch.gap * touch.normal_W;
  return ContactAt(model, data, wheel.body, wheel.radius, on_road, touch.normal_W);
}

}  // namespace

std::vector<TyreWheel> TyreWheelsOfCar(const CarModel& car, const mjModel& model) {
  const CarTyres& tyres = RequireTyres(car, "tyre: magic_formula");
  const VehicleParams& params = car.params();
  const CarParts& parts = car.parts();
  const double gravity = std::abs(model.opt.gravity[2]);
  const double weight = params.mass * gravity;
  const std::array<double, 2> nose =
      car.trailer() ? NoseLoads(car.trailer()->params, params.wheelbase, gravity)
                    : std::array<double, 2>{};
  std::vector<TyreWheel> wheels;
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    const std::size_t axle = AxleIndex(w);
    const double arm = axle == 0 ? params.cg_to_rear : params.cg_to_front();
    wheels.push_back({.geom = parts.tyre[w],
                      .body = parts.wheel[w],
                      .frame = parts.chassis,
                      .unsprung = model.body_subtreemass[parts.carrier[w]],
                      .radius = params.wheel_radius,
                      .spin_inertia = parts.spin_inertia[w],
                      .hub_height = parts.hub_height[w],
                      .load_at_rest = 0.5 * weight * arm / params.wheelbase + 0.5 * nose[axle],
                      .vertical_stiffness = tyres.vertical_stiffness,
                      .vertical_damping = tyres.vertical_damping,
                      .camber_gain = tyres.camber_gain[axle],
                      .tyre = &tyres.axle[axle]});
  }
  return wheels;
}

std::vector<TyreWheel> TyreWheelsOfTrailer(const CarModel& car, const mjModel& model) {
  const CarTyres& tyres = RequireTyres(car, "tyre: magic_formula");
  const TrailerParts& trailer = *car.trailer();
  const VehicleParams& params = car.params();
  const double gravity = std::abs(model.opt.gravity[2]);
  const double load = 0.5 * trailer.params.mass * gravity * (1.0 - trailer.params.nose_share());
  const double of_car = 0.5 * params.mass * gravity * params.cg_to_front() / params.wheelbase;
  std::vector<TyreWheel> wheels;
  for (std::size_t w = 0; w < trailer.wheel.size(); ++w) {
    wheels.push_back({.geom = trailer.tyre[w],
                      .body = trailer.wheel[w],
                      .frame = trailer.body,
                      .unsprung = model.body_subtreemass[trailer.carrier[w]],
                      .radius = trailer.params.wheel_radius,
                      .spin_inertia = trailer.spin_inertia[w],
                      .hub_height = trailer.hub_height - trailer.params.hitch_height,
                      .load_at_rest = load,
                      .vertical_stiffness = tyres.vertical_stiffness * load / of_car,
                      .vertical_damping = tyres.vertical_damping * load / of_car,
                      .tyre = &tyres.axle[1]});
  }
  return wheels;
}

MagicFormulaTyres::MagicFormulaTyres(const CarModel& car, const mjModel& model,
                                     std::vector<TyreWheel> wheels)
    : car_(car),
      timestep_(model.opt.timestep),
      gravity_(std::abs(model.opt.gravity[2])),
      wheels_(std::move(wheels)) {
  TRACKBED_CHECK(wheels_.size() <= shape_.size(), "{} wheels", wheels_.size());
  CheckTimestep(car);
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    shape_[w] = TyreShape(model, wheels_[w].geom);
  }
}

/// Checks that the numerical integration of the tyres is stable. The rotation of a wheel against
/// its tyre's stiffness is stable up to omega dt = sqrt(2), with the natural frequency omega and
/// the timestep dt. CheckTimestep assumes that one wheel carries the load of the whole axle. The
/// vertical motion of a wheel of mass m, on a tyre of stiffness k and damping c, is stable up to
/// k/m dt^2 + 2 c/m dt = 4, with the timestep dt.
void MagicFormulaTyres::CheckTimestep(const CarModel& car) const {
  double fastest = 0.0;                                      // [rad/s]
  double longest = std::numeric_limits<double>::infinity();  // [s]
  for (const TyreWheel& wheel : wheels_) {
    fastest = std::max(fastest, SpinFrequency(*wheel.tyre, 2.0 * wheel.load_at_rest, wheel.radius,
                                              wheel.spin_inertia));
    const double damping = wheel.vertical_damping / wheel.unsprung;
    longest = std::min(
        longest, 4.0 / (damping + std::sqrt(damping * damping +
                                            4.0 * wheel.vertical_stiffness / wheel.unsprung)));
  }
  const auto check = [&](double longest_step, const char* motion) {
    if (timestep_ > longest_step) {
      throw InputError(
          Problem{.key = "drive.timestep",
                  .message = fmt::format("{:.4g} s is too long for the tyres of {}: {} would be "
                                         "unstable; must be at most {:.4g} s",
                                         timestep_, car.file(), motion, longest_step)});
    }
  };
  check(std::sqrt(2.0) / fastest, "wheel spin");
  check(longest, "wheel hop");
}

double MagicFormulaTyres::Travel(const mjData& data, std::size_t w) const {
  const TyreWheel& wheel = wheels_[w];
  const Eigen::Map<const Eigen::Vector3d> hub(data.xpos + 3 * wheel.body);
  const Eigen::Map<const Eigen::Vector3d> frame(data.xpos + 3 * wheel.frame);
  const mjtNum* rotation = data.xmat + 9 * wheel.frame;
  const Eigen::Vector3d up(rotation[2], rotation[5], rotation[8]);
  return up.dot(hub - frame) - wheel.hub_height;
}

TyreTouch MagicFormulaTyres::Touch(const mjData& data, std::size_t w) const {
  const int geom = wheels_[w].geom;
  return shape_[w].On(
      car_.scene().ground, Eigen::Vector3d(data.geom_xpos + 3 * geom),
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.geom_xmat + 9 * geom));
}

double MagicFormulaTyres::Load(std::size_t w, double gap, double opening) const {
  const TyreWheel& wheel = wheels_[w];
  const double pressed = wheel.load_at_rest - wheel.vertical_stiffness * gap;
  // The total vertical tyre force is limited to 0 or more: damping must not pull a lifting tyre
  // toward the road or load a tyre in the air.
  return pressed <= 0.0 ? 0.0 : std::max(0.0, pressed - wheel.vertical_damping * opening);
}

void MagicFormulaTyres::Stand(const mjData& data) {
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    slips_[w] = {};
    states_[w] = {.normal_force = Load(w, Touch(data, w).gap, 0.0)};
  }
}

void MagicFormulaTyres::TakeLateralSlip(const mjModel& model, const mjData& data) {
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const TyreWheel& wheel = wheels_[w];
    const TyreTouch touch = Touch(data, w);
    const WheelContact contact = ContactOf(model, data, wheel, touch);
    const double speed = std::abs(contact.rolling_speed);
    slips_[w].y = speed > kAtRestSpeed ? contact.slip_speed_y / speed : 0.0;
  }
}

void MagicFormulaTyres::Apply(const mjModel& model, mjData& data, std::span<const double> road) {
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const TyreWheel& wheel = wheels_[w];
    const TyreTouch touch = Touch(data, w);
    const WheelContact contact = ContactOf(model, data, wheel, touch);
    const double radius = wheel.radius;
    const Eigen::Map<const Eigen::Vector3d> hub(data.xipos + 3 * wheel.body);
    const double opening = touch.normal_W.dot(contact.hub_velocity +
                                              contact.angular_velocity.cross(touch.lowest_W - hub));
    const MagicFormula& tyre = *wheel.tyre;
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
    const double spin_omega = SpinFrequency(tyre, load, radius, wheel.spin_inertia);
    const double side_omega = std::sqrt(c_alpha * gravity_ / (sigma_y * load));
    // The damping time tau_x is limited to the time constant of the slip, sigma_x/speed.
    const double damping = Damping(spin_omega, timestep_);
    const double tau_x = speed * damping > sigma_x ? sigma_x / speed : damping;
    const double tau_y =
        speed < kWalkingPace ? Damping(side_omega, timestep_) * (1.0 - speed / kWalkingPace) : 0.0;
    const Relaxation along(speed, sigma_x, timestep_);
    const double kappa = along.Step(slip.x, contact.slip_speed_x, tau_x);
    // If both relaxation lengths are equal, as in most tyres, evaluate the exponential function
    // only once.
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
    const double camber = lean + side * wheel.camber_gain * travel;
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
    // whatever the height of the hub. If the longitudinal force had another lever arm than R, the
    // road would do work on a wheel without slip.
    const double arm = contact.up.dot(hub - contact.point);
    const Eigen::Vector3d moment =
        -(rolling + state.longitudinal_force * (radius - arm)) * contact.spin_axis;
    AddForce(model, data, wheel.body, contact.point, push, moment);
  }
}

std::array<WheelState, 4> MagicFormulaTyres::Observe() const {
  std::array<WheelState, 4> wheels = states_;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    wheels[w].slip_ratio = slips_[w].x;
    wheels[w].slip_angle = std::atan(slips_[w].y);
    wheels[w].friction_use =
        FrictionUse(*wheels_[w].tyre, wheels[w].normal_force, contact_[w].road, contact_[w].camber,
                    {wheels[w].longitudinal_force, wheels[w].lateral_force});
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
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    sum += wheels_[w].tyre->rolling_resistance * states_[w].normal_force * wheels_[w].radius;
  }
  return sum;
}

}  // namespace trackbed
