#pragma once

#include "src/sim/wheel_contacts.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The tyres of one car between its frictionless contacts and the road: slip with a relaxation
/// length, forces by the Magic Formula.
///
/// A slip s follows its steady value v_s/|v_x| over the relaxation length,
///   sigma ds/dt = v_s - |v_x| s,
/// solved exactly over a timestep with speeds held, so that it holds at standstill, where s is a
/// deflection of the tyre over sigma. The force is that of the slip s + tau ds/dt: damping of the
/// carcass that changes nothing in steady slip. Along x, tau damps a wheel spinning on its tyre
/// critically at any speed; along y it fades out above walking pace, where rolling damps.
class MagicFormulaTyres {
 public:
  /// Makes the wheels' contacts of `model` frictionless, with the car's vertical tyre stiffness.
  /// InputError as RequireTyres when the car has no tyre coefficients, and when its timestep is too
  /// long for them.
  MagicFormulaTyres(const CarModel& car, mjModel_& model);

  /// The forces for the step that begins now, added to what is applied to the joints in `data`;
  /// called between mj_step1 and mj_step2. `loads` are the wheels' normal forces, `road` the road's
  /// factors under them.
  void Apply(const mjModel_& model, mjData_& data, const std::array<double, 4>& loads,
             const std::array<double, 4>& road);

  /// Before the first step: tyres without slip under `loads`.
  void Stand(const std::array<double, 4>& loads);

  /// What Apply found last.
  [[nodiscard]] const std::array<WheelState, 4>& wheels() const { return states_; }

  /// The moment that rolling resistance takes at `load`, all four wheels together [N m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car, double weight) const;

  /// How far the wheel is up from where it stands at rest [m].
  [[nodiscard]] double Travel(const mjData_& data, std::size_t wheel) const;

  struct Slip {
    double x = 0.0;
    double y = 0.0;
  };

  const CarModel& car_;
  double timestep_;
  double gravity_;
  std::array<Slip, 4> slips_{};
  std::array<WheelState, 4> states_{};
};

}  // namespace trackbed
