#pragma once

#include "src/sim/tyre_shape.h"
#include "src/sim/wheel_contacts.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The tyres of one car: vertical springs to the ground, slip with a relaxation length, forces by
/// the Magic Formula. They take the place of MuJoCo's contacts with the ground
/// (TyreSupport::kSprings), so that a car on the road has no constraints to solve.
///
/// Normal to the ground a tyre is a spring of stiffness k with damping c,
///   F_z = max(0, F_z0 - k gap - c d(gap)/dt)   while F_z0 > k gap, else 0;
/// F_z0 is what the wheel carries at rest, where the model's tyre touches the ground (gap = 0).
///
/// A slip s follows its steady value v_s/|v_x| over the relaxation length,
///   sigma ds/dt = v_s - |v_x| s,
/// solved exactly over a timestep with speeds held, so that it holds at standstill, where s is a
/// deflection of the tyre over sigma. The force is that of the slip s + tau ds/dt: damping of the
/// carcass that changes nothing in steady slip. Along x, tau damps a wheel spinning on its tyre
/// critically at any speed; along y it fades out above walking pace, where rolling damps.
class MagicFormulaTyres {
 public:
  /// InputError as RequireTyres when the car has no tyre coefficients, and when its timestep is too
  /// long for them.
  MagicFormulaTyres(const CarModel& car, const mjModel_& model);

  /// The forces for the step that begins now, added to what is applied to the joints in `data`;
  /// called between mj_step1 and mj_step2. `road` is the road's factors under the wheels.
  void Apply(const mjModel_& model, mjData_& data, const std::array<double, 4>& road);

  /// Before the first step, from the positions in `data`: tyres without slip.
  void Stand(const mjData_& data);

  /// After Stand, from the speeds in `data`: every rolling tyre with the steady slip of its lateral
  /// motion.
  void TakeLateralSlip(const mjModel_& model, const mjData_& data);

  /// What Apply found last.
  [[nodiscard]] std::array<WheelState, 4> Observe() const;

  /// The moment that rolling resistance takes at `load`, all four wheels together [N m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car, double weight, const mjModel_& model) const;

  [[nodiscard]] TyreTouch Touch(const mjData_& data, std::size_t wheel) const;
  /// F_z at a gap [m] that opens [m/s].
  [[nodiscard]] double Load(std::size_t wheel, double gap, double opening) const;

  /// How far the wheel is up from where it stands at rest [m].
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
  std::array<WheelState, 4> states_{};  // but for the slips
};

}  // namespace trackbed
