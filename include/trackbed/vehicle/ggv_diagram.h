#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// The g-g-v diagram of a car: the accelerations that its tyres, motor and brakes allow at each
/// speed.
///
/// Symbols, along the road's surface, per mass of the car [m/s^2], including gravity:
///   f_x  force of all tyres along the car, positive when driving
///   f_y  force of all tyres across the car; only its magnitude matters
///   f_n  load on the road; g on a level road
///   v    speed [m/s];  f the road's factor on the tyres' friction [1]
/// On a level road the car's acceleration is a_x = f_x - D/m and a_y = f_y, D being the drag.
///
/// Tyre forces are those at f_n = g and scale with f_n: exact for friction that does not depend on
/// the load.
namespace trackbed {

/// The boundary of f_x over f_y at one speed on one road.
struct GgvSection {
  double speed = 0.0;    ///< v [m/s], >= 0
  double road = 1.0;     ///< f [1], > 0
  double lateral = 0.0;  ///< the largest f_y [m/s^2], > 0
  /// The largest and the smallest f_x [m/s^2] at f_y = lateral cos(q), with q from 0 to pi/2 in
  /// equal steps, that is, from the largest f_y to straight ahead. In between linear in sin(q), as
  /// an ellipse is.
  std::vector<double> driving;
  std::vector<double> braking;
};

/// The longitudinal forces of a car, except those of its tyres.
struct LongitudinalForces {
  double mass = 0.0;                ///< m [kg], > 0
  double rolling_mass = 0.0;        ///< m and the wheels' inertia over the radius squared [kg]
  double drive_force = 0.0;         ///< largest, of the motor at the wheels [N]; 0: no limit
  double drive_power = 0.0;         ///< largest [W]; 0: no limit
  double brake_force = 0.0;         ///< largest, of the brakes at the wheels [N]; 0: no limit
  double rolling_resistance = 0.0;  ///< including that of the bearings [N]
  double drag = 0.0;                ///< D/v^2 = rho C_d A/2 in still air [kg/m]
  double top_speed = 0.0;           ///< [m/s]; 0: no limit
};

/// The point of a car on the diagram.
struct GgvPoint {
  double speed = 0.0;    ///< v [m/s]
  double road = 1.0;     ///< f [1]
  double load = 1.0;     ///< f_n/g [1]
  double lateral = 0.0;  ///< f_y [m/s^2]
};

/// A range of f_x [m/s^2].
struct TyreRange {
  double braking = 0.0;
  double driving = 0.0;
};

/// A range of accelerations [m/s^2].
struct AccelerationRange {
  double smallest = 0.0;
  double largest = 0.0;
};

/// Immutable. Between sections, values are linear in v^2 and in the road's factor. Beyond the
/// speeds of the sections, they are those of the nearest section; beyond the roads, proportional to
/// the factor.
class GgvDiagram {
 public:
  /// InternalError unless there is a section for every pair of the speeds and roads that occur, all
  /// with the same number of values, at least two, finite and with braking <= driving; and unless
  /// masses are positive and forces nonnegative.
  GgvDiagram(const LongitudinalForces& forces, std::vector<GgvSection> sections);

  [[nodiscard]] const LongitudinalForces& forces() const { return forces_; }
  /// By road, then by speed, both rising.
  [[nodiscard]] const std::vector<GgvSection>& sections() const { return sections_; }

  /// The largest f_y [m/s^2]; ignores the point's f_y. Cost: below 0.1 us.
  [[nodiscard]] double MaxLateral(const GgvPoint& point) const;

  /// The range of f_x that the tyres allow at f_y, which is clamped to the largest f_y. Ignores the
  /// limits of motor and brakes. Cost: below 0.1 us.
  [[nodiscard]] TyreRange TyresAt(const GgvPoint& point) const;

  /// The range of the acceleration along the road [m/s^2] at f_y, with a fraction `share` of the
  /// forces of tyres, motor and brakes, minus the drag and `slope`, the part of gravity along the
  /// road, positive uphill [m/s^2].
  [[nodiscard]] AccelerationRange AccelerationsAt(const GgvPoint& point, double share = 1.0,
                                                  double slope = 0.0) const;

  /// Largest force of the motor at the wheels [N] at a speed; infinite without a limit.
  [[nodiscard]] double DriveForce(double speed) const;

 private:
  /// The sections around a point, with their weights.
  struct Weights {
    std::array<const GgvSection*, 4> section{};
    std::array<double, 4> weight{};
    std::size_t count = 0;
  };
  [[nodiscard]] Weights WeightsAt(const GgvPoint& point) const;

  LongitudinalForces forces_;
  std::vector<double> speeds_;
  std::vector<double> roads_;
  std::vector<GgvSection> sections_;  // by road, then by speed
};

/// An ellipse with the half axes `driving` ahead, `braking` behind and `lateral` to the sides
/// [m/s^2], all > 0, for speed 0 and a road of factor 1. Two values represent it exactly.
GgvSection EllipticSection(double driving, double braking, double lateral);

}  // namespace trackbed
