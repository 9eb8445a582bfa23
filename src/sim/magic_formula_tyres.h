#pragma once

#include "src/sim/tyre_shape.h"
#include "src/sim/wheel_contacts.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The tyres of one car: vertical springs to the ground, slip with a relaxation length, forces by
/// the Magic Formula. They replace MuJoCo's contacts with the ground (TyreSupport::kSprings), so
/// that a car on the road has no constraints to solve.
///
/// Normal to the ground a tyre is a spring of stiffness k with damping c,
///   F_z = max(0, F_z0 - k gap - c d(gap)/dt)   while F_z0 > k gap, else 0;
/// F_z0 is the wheel load at rest, where the model's tyre touches the ground (gap = 0).
///
/// A slip s follows its steady value v_s/|v_x| over the relaxation length,
///   sigma ds/dt = v_s - |v_x| s,
/// solved exactly over a timestep at constant speeds. Thus it also holds at standstill, where s is
/// a deflection of the tyre over sigma. The force is that of the slip s + tau ds/dt: damping of the
/// carcass, without effect in steady slip. Along x, tau damps the spin of a wheel on its tyre
/// critically at any speed. Along y it fades out up to walking pace, since rolling then damps.
class MagicFormulaTyres {
 public:
  /// InputError as RequireTyres if the car has no tyre coefficients, and if its timestep is too
  /// long for a stable integration.
  MagicFormulaTyres(const CarModel& car, const mjModel_& model);

  /// Adds the tyre forces of the coming step to the forces on the joints in `data`. Must be called
  /// between mj_step1 and mj_step2. `road` has the road's friction factors under the wheels.
  void Apply(const mjModel_& model, mjData_& data, const std::array<double, 4>& road);

  /// Initializes tyres without slip before the first step, from the positions in `data`.
  void Stand(const mjData_& data);

  /// After Stand: gives every rolling tyre the steady slip of its lateral speed in `data`.
  void TakeLateralSlip(const mjModel_& model, const mjData_& data);

  /// The wheel states computed by the last Apply.
  [[nodiscard]] std::array<WheelState, 4> Observe() const;

  /// Moment of the rolling resistance of all four wheels at their present loads [N m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car, double weight, const mjModel_& model) const;

  [[nodiscard]] TyreTouch Touch(const mjData_& data, std::size_t wheel) const;
  /// F_z at a gap [m] that increases at `opening` [m/s].
  [[nodiscard]] double Load(std::size_t wheel, double gap, double opening) const;

  /// Height of the wheel above its position at rest, relative to the chassis [m].
  [[nodiscard]] double Travel(const mjData_& data, std::size_t wheel) const;

  struct Slip {
    double x = 0.0;
    double y = 0.0;
  };

  const CarModel& car_;
  double timestep_;
  double gravity_;
  std::array<double, 4> load_at_rest_{};  // F_z0 [N]
  std::array<TyreShape, 4> shape_;
  std::array<Slip, 4> slips_{};
  std::array<WheelState, 4> states_{};  // without slips
};

}  // namespace trackbed
