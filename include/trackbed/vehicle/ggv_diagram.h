#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// The g-g-v diagram of a car: the accelerations that its tyres, motor and brakes allow at each
/// speed.
///
/// The forces f_x, f_y and f_n are divided by the car's mass [m/s^2], act along the axes of the
/// road's surface, and include gravity. The symbols are:
///   f_x: force of all tyres along the car, positive when driving.
///   f_y: force of all tyres across the car; only the magnitude of f_y matters.
///   f_n: load on the road, equal to g on a level road.
///   v: speed [m/s].
///   f: friction factor of the road, by which the tyres' friction coefficients are multiplied [1].
/// On a level road, the car's acceleration is a_x = f_x - D/m and a_y = f_y, where D is the drag.
///
/// Tyre forces are computed at the load of a level road, f_n = g, and scaled in proportion to f_n.
/// Scaling the tyre forces in proportion to the load f_n is exact if the tyres' friction
/// coefficient does not depend on the load.
namespace trackbed {

/// The limits of the longitudinal force f_x as a function of the lateral force f_y, at one speed
/// and one friction factor.
struct GgvSection {
  double speed = 0.0;    ///< Speed v [m/s], >= 0.
  double road = 1.0;     ///< Friction factor f of the road [1], > 0.
  double lateral = 0.0;  ///< Largest lateral force f_y [m/s^2], > 0.
  /// The largest (`driving`) and the smallest (`braking`) longitudinal force f_x [m/s^2] at the
  /// lateral forces f_y = `lateral` cos(q), for several angles q. The angle q that defines the
  /// lateral force increases in equal steps from 0 (largest f_y) to pi/2 (straight ahead). Between
  /// two values of the angle q, the longitudinal force f_x is interpolated linearly in sin(q),
  /// which is exact for an ellipse.
  std::vector<double> driving;
  std::vector<double> braking;
};

/// The longitudinal forces of a car, except the forces of its tyres.
struct LongitudinalForces {
  double mass = 0.0;  ///< Mass m of the car [kg], > 0.
  /// Effective mass for accelerations [kg]: the car's mass plus the wheels' moment of inertia
  /// divided by the squared wheel radius.
  double rolling_mass = 0.0;
  double drive_force = 0.0;  ///< Largest force of the motor at the wheels [N]; 0: no limit.
  double drive_power = 0.0;  ///< Largest power of the motor [W]; 0: no limit.
  double brake_force = 0.0;  ///< Largest force of the brakes at the wheels [N]; 0: no limit.
  /// Rolling resistance of the car, including bearing friction [N].
  double rolling_resistance = 0.0;
  double drag = 0.0;       ///< Drag coefficient D/v^2 = rho C_d A/2 in still air [kg/m].
  double top_speed = 0.0;  ///< Top speed of the car [m/s]; 0: no limit.
};

/// An operating point of a car in the g-g-v diagram.
struct GgvPoint {
  double speed = 0.0;    ///< Speed v of the car [m/s].
  double road = 1.0;     ///< Friction factor f of the road [1].
  double load = 1.0;     ///< Load on the road relative to a level road, f_n/g [1].
  double lateral = 0.0;  ///< Lateral tyre force f_y, divided by the car's mass [m/s^2].
};

/// A range of the longitudinal tyre force f_x, divided by the car's mass [m/s^2].
struct TyreRange {
  double braking = 0.0;
  double driving = 0.0;
};

/// A range of longitudinal accelerations [m/s^2].
struct AccelerationRange {
  double smallest = 0.0;
  double largest = 0.0;
};

/// A g-g-v diagram. Immutable. Between the sections of a g-g-v diagram, the force limits are
/// interpolated linearly in the squared speed and in the road's friction factor. For speeds beyond
/// the range of the sections, the force limits are those of the nearest section. For friction
/// factors beyond the range of the sections, the force limits are proportional to the friction
/// factor.
class GgvDiagram {
 public:
  /// Throws InternalError unless `sections` has one section for every combination of its speeds and
  /// friction factors. All sections must have the same number of force limits, at least two. All
  /// force limits of the sections must be finite, with braking <= driving. Throws InternalError
  /// unless all masses are positive and all forces are nonnegative.
  GgvDiagram(const LongitudinalForces& forces, std::vector<GgvSection> sections);

  [[nodiscard]] const LongitudinalForces& forces() const { return forces_; }
  /// Returns the sections of the diagram, sorted by increasing friction factor of the road, then by
  /// increasing speed.
  [[nodiscard]] const std::vector<GgvSection>& sections() const { return sections_; }

  /// Returns the largest lateral force f_y [m/s^2] at the speed, friction factor and load of
  /// `point`. Cost: below 0.1 us.
  [[nodiscard]] double MaxLateral(const GgvPoint& point) const;

  /// Returns the range of the longitudinal force f_x that the tyres allow at the lateral force f_y
  /// of `point`. A lateral force f_y beyond the largest possible one is clamped. TyresAt ignores
  /// the limits of the motor and the brakes. Cost: below 0.1 us.
  [[nodiscard]] TyreRange TyresAt(const GgvPoint& point) const;

  /// Returns the range of the acceleration along the road [m/s^2] at the lateral force of `point`.
  /// The forces of tyres, motor and brakes are multiplied by `share`; the drag and `slope` are
  /// subtracted. The argument `slope` is the component of gravity along the road [m/s^2], positive
  /// uphill.
  [[nodiscard]] AccelerationRange AccelerationsAt(const GgvPoint& point, double share = 1.0,
                                                  double slope = 0.0) const;

  /// Returns the largest force of the motor at the wheels [N] at a speed; infinity if the motor has
  /// no limit.
  [[nodiscard]] double DriveForce(double speed) const;

 private:
  /// The sections between which an operating point lies, with their interpolation weights.
  struct Weights {
    std::array<const GgvSection*, 4> section{};
    std::array<double, 4> weight{};
    std::size_t count = 0;
  };
  [[nodiscard]] Weights WeightsAt(const GgvPoint& point) const;

  LongitudinalForces forces_;
  std::vector<double> speeds_;
  std::vector<double> roads_;
  // Sections of the diagram in order of the road's friction factor, then in order of speed.
  std::vector<GgvSection> sections_;
};

/// Makes an elliptic section of a g-g-v diagram with the half axes `driving` (positive f_x),
/// `braking` (negative f_x) and `lateral` (f_y) [m/s^2], all > 0. The elliptic section is for the
/// speed 0 and the road friction factor 1. Two limits of f_x for driving and two for braking
/// represent the ellipse exactly, because GgvSection interpolates along ellipses.
GgvSection EllipticSection(double driving, double braking, double lateral);

}  // namespace trackbed
