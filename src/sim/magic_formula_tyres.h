#pragma once

#include "src/sim/tyre_shape.h"
#include "src/sim/wheel_contacts.h"
#include "src/sim/wheel_slip_control.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// Computes the tyre forces of a car. A tyre is modeled as a spring normal to the ground; its
/// forces along the ground follow from the Magic Formula, with slips that have a relaxation length.
/// The springs replace MuJoCo's contacts between tyres and ground (TyreSupport::kSprings), so
/// MuJoCo has no contact constraints to solve for a car on the road.
///
/// Normal to the ground, a tyre is a spring of stiffness k with damping c. The gap is the distance
/// between the tyre's geom and the ground. While F_z0 > k gap, the load of the tyre is
///   F_z = max(0, F_z0 - k gap - c d(gap)/dt);
/// otherwise the load is 0. F_z0 is the wheel load at rest, where the tyre of the model just
/// touches the ground (gap = 0).
///
/// The longitudinal or lateral slip s approaches its steady value v_s/|v_x| over the relaxation
/// length sigma, where v_s is the slip speed and v_x the rolling speed:
///   sigma ds/dt = v_s - |v_x| s.
/// The equation of the slip is solved exactly over each timestep, with constant speeds. The exact
/// solution is also valid at standstill, where s is the deflection of the tyre divided by sigma.
///
/// The argument of the Magic Formula is s + tau ds/dt. The term tau ds/dt represents the damping of
/// the tyre's carcass, which has no effect in steady slip. In the longitudinal direction, tau
/// critically damps the wheel's rotation against the tyre's stiffness at any speed. In the lateral
/// direction, tau decreases to zero as the speed rises to walking pace, since rolling then damps
/// lateral motion.
class MagicFormulaTyres {
 public:
  /// Throws the InputError of RequireTyres if the car has no tyre coefficients. Throws InputError
  /// if the car's timestep is too long for a stable integration.
  MagicFormulaTyres(const CarModel& car, const mjModel_& model);

  /// Adds the tyre forces of the coming step to the joint forces in `data`. Apply() must be called
  /// between mj_step1 and mj_step2. `road` has the friction factor of the road under each wheel.
  void Apply(const mjModel_& model, mjData_& data, const std::array<double, 4>& road);

  /// Initializes the tyres with zero slip, at the positions in `data`. Stand() must be called
  /// before the first step.
  void Stand(const mjData_& data);

  /// Sets the lateral slip of every rolling tyre to its steady-state value at the speed in `data`.
  /// TakeLateralSlip must be called after Stand.
  void TakeLateralSlip(const mjModel_& model, const mjData_& data);

  /// Returns the wheel states that the last call of Apply computed.
  [[nodiscard]] std::array<WheelState, 4> Observe() const;

  /// Returns the rolling speed, the load and the longitudinal force of a wheel, as computed by the
  /// last call of Apply.
  [[nodiscard]] WheelMotion Motion(std::size_t wheel) const;

  /// Returns the sum of the rolling resistance moments of all four wheels at their present loads [N
  /// m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car, double weight, const mjModel_& model) const;

  [[nodiscard]] TyreTouch Touch(const mjData_& data, std::size_t wheel) const;
  /// Returns the load F_z of a tyre [N] from its gap [m] and the rate `opening` at which the gap
  /// increases [m/s].
  [[nodiscard]] double Load(std::size_t wheel, double gap, double opening) const;

  /// Returns the height of a wheel above its rest position, relative to the chassis [m].
  [[nodiscard]] double Travel(const mjData_& data, std::size_t wheel) const;

  struct Slip {
    double x = 0.0;
    double y = 0.0;
  };

  struct Contact {
    double road = 1.0;           // Friction factor of the road.
    double camber = 0.0;         // Camber of the wheel [rad].
    double rolling_speed = 0.0;  // Forward speed of the hub [m/s].
  };

  const CarModel& car_;
  double timestep_;
  double gravity_;
  std::array<double, 4> load_at_rest_{};  // F_z0 [N]
  std::array<TyreShape, 4> shape_;
  std::array<Slip, 4> slips_{};
  std::array<Contact, 4> contact_{};
  std::array<WheelState, 4> states_{};  // states of all wheels, without slip values
};

}  // namespace trackbed
