#pragma once

#include "src/sim/tyre_shape.h"
#include "src/sim/wheel_contacts.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The tyres of one car. The tyres are vertical springs to the ground, have slip with a relaxation
/// length, and give forces by the Magic Formula. The springs of the tyres replace MuJoCo's contacts
/// with the ground (TyreSupport::kSprings). A car on the road therefore has no constraints to
/// solve.
///
/// Normal to the ground, a tyre is a spring of stiffness k with damping c. While F_z0 > k gap, the
/// load is
///   F_z = max(0, F_z0 - k gap - c d(gap)/dt),
/// else it is 0. F_z0 is the wheel load at rest, where the model's tyre touches the ground
/// (gap = 0).
///
/// A slip s approaches its steady value v_s/|v_x| over the relaxation length sigma:
///   sigma ds/dt = v_s - |v_x| s.
/// The equation is solved exactly over a timestep at constant speeds. The solution therefore also
/// holds at standstill, where s is a deflection of the tyre over sigma.
///
/// The force of a tyre is that of the slip s + tau ds/dt. The term with tau is the damping of the
/// carcass, which has no effect in steady slip. Along x, tau critically damps the spin of a wheel
/// on its tyre at any speed. Along y, tau decreases to zero at walking pace, since rolling then
/// damps.
class MagicFormulaTyres {
 public:
  /// Throws the InputError of RequireTyres if the car has no tyre coefficients. Throws InputError
  /// if the car's timestep is too long for a stable integration.
  MagicFormulaTyres(const CarModel& car, const mjModel_& model);

  /// Adds the tyre forces of the coming step to the forces on the joints in `data`. Apply() must be
  /// called between mj_step1 and mj_step2. `road` has the road's friction factors under the wheels.
  void Apply(const mjModel_& model, mjData_& data, const std::array<double, 4>& road);

  /// Initializes tyres without slip before the first step, from the positions in `data`.
  void Stand(const mjData_& data);

  /// Gives every rolling tyre the steady slip of its lateral speed in `data`. TakeLateralSlip must
  /// be called after Stand.
  void TakeLateralSlip(const mjModel_& model, const mjData_& data);

  /// The wheel states that the last call of Apply computed.
  [[nodiscard]] std::array<WheelState, 4> Observe() const;

  /// Moment of the rolling resistance of all four wheels at their present loads [N m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car, double weight, const mjModel_& model) const;

  [[nodiscard]] TyreTouch Touch(const mjData_& data, std::size_t wheel) const;
  /// Load F_z of a tyre at a gap [m] that increases at `opening` [m/s].
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
  std::array<WheelState, 4> states_{};  // wheel states without their slips
};

}  // namespace trackbed
