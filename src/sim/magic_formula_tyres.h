#pragma once

#include <span>
#include <vector>

#include "src/sim/tyre_shape.h"
#include "src/sim/wheel_contacts.h"
#include "src/sim/wheel_slip_control.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// A wheel with a Magic Formula tyre.
struct TyreWheel {
  int geom = -1;                    ///< Index of the tyre's collision geom.
  int body = -1;                    ///< Index of the wheel's body.
  int frame = -1;                   ///< Index of the body that carries the suspension.
  double unsprung = 0.0;            ///< Mass that moves with the wheel on its spring [kg].
  double radius = 0.0;              ///< Radius of the wheel [m].
  double spin_inertia = 0.0;        ///< Wheel's moment of inertia about the spin axis [kg m^2].
  double hub_height = 0.0;          ///< Height of the wheel center above the origin of `frame` [m].
  double load_at_rest = 0.0;        ///< Wheel load F_z0 at rest [N].
  double vertical_stiffness = 0.0;  ///< [N/m]
  double vertical_damping = 0.0;    ///< [N s/m]
  double camber_gain = 0.0;         ///< Same as CarTyres::camber_gain [rad/m].
  const MagicFormula* tyre = nullptr;
};

/// Returns the wheels of a car. Throws the InputError of RequireTyres if the car has no tyre
/// coefficients.
std::vector<TyreWheel> TyreWheelsOfCar(const CarModel& car, const mjModel_& model);
/// Returns the wheels of the car's trailer. The trailer's tyres have the coefficients of the car's
/// rear tyres. The vertical stiffness and damping of the rear tyres are scaled in proportion to the
/// load at rest.
std::vector<TyreWheel> TyreWheelsOfTrailer(const CarModel& car, const mjModel_& model);

/// Computes the tyre forces of a car or of its trailer. A tyre is modeled as a spring normal to the
/// ground. The Magic Formula yields the tyre's forces along the ground, from slips that lag by a
/// relaxation length. The springs replace MuJoCo's contacts between tyres and ground
/// (TyreSupport::kSprings), so MuJoCo has no contact constraints to solve for a car on the road.
///
/// Normal to the ground, a tyre is a spring of stiffness k with damping c. The gap is the distance
/// between the tyre's geom and the ground. While F_z0 > k gap, the tyre is on the ground and its
/// load is
///   F_z = max(0, F_z0 - k gap - c d(gap)/dt);
/// otherwise the tyre's load is 0. F_z0 is the wheel load at rest, where the tyre of the model just
/// touches the ground (gap = 0).
///
/// The longitudinal or lateral slip s approaches its steady value v_s/|v_x| over the relaxation
/// length sigma, where v_s is the slip speed and v_x the rolling speed:
///   sigma ds/dt = v_s - |v_x| s.
/// The equation of the slip is solved exactly over each timestep, with constant speeds. The exact
/// solution of the slip s is also valid at standstill, where s is the deflection of the tyre
/// divided by sigma.
///
/// The argument of the Magic Formula is the damped slip s + tau ds/dt. The term tau ds/dt, with the
/// damping time tau, represents the damping of the tyre's carcass, which has no effect in steady
/// slip. In the longitudinal direction, the damping time tau critically damps the wheel's rotation
/// against the tyre's stiffness at any speed. In the lateral direction, the damping time tau
/// decreases to zero as the speed rises to walking pace, since rolling then damps lateral motion.
class MagicFormulaTyres {
 public:
  /// The list `wheels` has at most four wheels, on one or two axles, each with the left wheel
  /// before the right one. Throws InputError if the car's timestep is too long for a stable
  /// integration.
  MagicFormulaTyres(const CarModel& car, const mjModel_& model, std::vector<TyreWheel> wheels);

  /// Adds the tyre forces of the coming step to the joint forces in `data`. Apply() must be called
  /// between mj_step1 and mj_step2. `road` has the friction factor of the road under each wheel.
  void Apply(const mjModel_& model, mjData_& data, std::span<const double> road);

  /// Initializes the tyres with zero slip, at the positions in `data`. Stand() must be called
  /// before the first step.
  void Stand(const mjData_& data);

  /// Sets the lateral slip of every rolling tyre to its steady-state value at the speed in `data`.
  /// TakeLateralSlip must be called after Stand.
  void TakeLateralSlip(const mjModel_& model, const mjData_& data);

  /// Returns the wheel states that the last call of Apply computed, in the order of the wheels.
  [[nodiscard]] std::array<WheelState, 4> Observe() const;

  /// Returns the rolling speed, the load and the longitudinal force of a wheel, as computed by the
  /// last call of Apply.
  [[nodiscard]] WheelMotion Motion(std::size_t wheel) const;

  /// Returns the sum of the rolling resistance moments of all wheels at their present loads [N m].
  [[nodiscard]] double RollingMoment() const;

 private:
  void CheckTimestep(const CarModel& car) const;

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
  std::vector<TyreWheel> wheels_;
  std::array<TyreShape, 4> shape_;
  std::array<Slip, 4> slips_{};
  std::array<Contact, 4> contact_{};
  std::array<WheelState, 4> states_{};  // states of all wheels, without slip values
};

}  // namespace trackbed
