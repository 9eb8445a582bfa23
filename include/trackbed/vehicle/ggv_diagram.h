#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// The g-g-v diagram of a car: the accelerations that its tyres, motor and brakes allow at each
/// speed.
///
/// Symbols. The forces are divided by the car's mass [m/s^2], act along the axes of the road's
/// surface, and include gravity:
///   f_x  force of all tyres along the car, positive when driving
///   f_y  force of all tyres across the car; only its magnitude matters
///   f_n  load on the road; g on a level road
///   v    speed [m/s];  f the road's factor on the tyres' friction [1]
/// On a level road the car's acceleration is a_x = f_x - D/m and a_y = f_y, D being the drag.
///
/// Tyre forces are computed at the load of a level road, f_n = g, and scaled in proportion to f_n.
/// The scaling is exact if the friction does not depend on the load.
namespace trackbed {

/// The limits of the longitudinal force f_x as a function of the lateral force f_y, at one speed on
/// one road.
struct GgvSection {
  double speed = 0.0;    ///< Speed v [m/s], >= 0.
  double road = 1.0;     ///< Road factor f [1], > 0.
  double lateral = 0.0;  ///< Largest f_y [m/s^2], > 0.
  /// The largest and the smallest longitudinal force f_x [m/s^2] at the lateral force f_y = lateral
  /// cos(q). The angle q runs in equal steps from 0 (largest f_y) to pi/2 (straight ahead). Between
  /// two steps, f_x is linear in sin(q), as for an ellipse.
  std::vector<double> driving;
  std::vector<double> braking;
};

/// The longitudinal forces of a car, except those of its tyres.
struct LongitudinalForces {
  double mass = 0.0;          ///< Mass m [kg], > 0.
  double rolling_mass = 0.0;  ///< Mass m plus the wheels' inertia over the radius squared [kg].
  double drive_force = 0.0;   ///< Largest force of the motor at the wheels [N]; 0: no limit.
  double drive_power = 0.0;   ///< Largest power of the motor [W]; 0: no limit.
  double brake_force = 0.0;   ///< Largest force of the brakes at the wheels [N]; 0: no limit.
  double rolling_resistance = 0.0;  ///< Rolling resistance, including that of the bearings [N].
  double drag = 0.0;                ///< Drag D/v^2 = rho C_d A/2 in still air [kg/m].
  double top_speed = 0.0;           ///< Top speed [m/s]; 0: no limit.
};

/// An operating point of a car in the g-g-v diagram.
struct GgvPoint {
  double speed = 0.0;    ///< Speed v [m/s].
  double road = 1.0;     ///< Road factor f [1].
  double load = 1.0;     ///< Relative load f_n/g [1].
  double lateral = 0.0;  ///< Lateral force f_y [m/s^2].
};

/// A range of the longitudinal tyre force f_x, divided by the car's mass [m/s^2].
struct TyreRange {
  double braking = 0.0;
  double driving = 0.0;
};

/// A range of accelerations [m/s^2].
struct AccelerationRange {
  double smallest = 0.0;
  double largest = 0.0;
};

/// A g-g-v diagram. Immutable. Between sections, values are linear in v^2 and in the road's factor.
/// Beyond the range of the sections' speeds, values are those of the nearest section. Beyond the
/// range of the sections' road factors, values are proportional to the road factor.
class GgvDiagram {
 public:
  /// InternalError unless there is a section for every pair of a speed and a road factor that occur
  /// in `sections`. All sections must have the same number of values, at least two, which are
  /// finite and have braking <= driving. InternalError unless masses are positive and forces are
  /// nonnegative.
  GgvDiagram(const LongitudinalForces& forces, std::vector<GgvSection> sections);

  [[nodiscard]] const LongitudinalForces& forces() const { return forces_; }
  /// The sections, sorted by increasing road factor, then by increasing speed.
  [[nodiscard]] const std::vector<GgvSection>& sections() const { return sections_; }

  /// Returns the largest lateral force f_y [m/s^2] at the point's speed, road factor and load.
  /// Cost: below 0.1 us.
  [[nodiscard]] double MaxLateral(const GgvPoint& point) const;

  /// Returns the range of the longitudinal force f_x that the tyres allow at the point's lateral
  /// force f_y, which is clamped to the largest one. The limits of motor and brakes are ignored.
  /// Cost: below 0.1 us.
  [[nodiscard]] TyreRange TyresAt(const GgvPoint& point) const;

  /// Returns the range of the acceleration along the road [m/s^2] at the point's lateral force. The
  /// tyres, motor and brakes contribute the fraction `share` of their forces; the drag and `slope`
  /// are subtracted. `slope` is the component of gravity along the road [m/s^2], positive uphill.
  [[nodiscard]] AccelerationRange AccelerationsAt(const GgvPoint& point, double share = 1.0,
                                                  double slope = 0.0) const;

  /// Returns the largest force of the motor at the wheels [N] at a speed; infinite without a limit.
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
  std::vector<GgvSection> sections_;  // Sections by road, then by speed.
};

/// Makes an elliptic section with the half axes `driving` ahead, `braking` behind and `lateral` to
/// the sides [m/s^2], all > 0. The speed is 0 and the road's factor 1. The section has two values
/// each for driving and braking, which represent the ellipse exactly.
GgvSection EllipticSection(double driving, double braking, double lateral);

}  // namespace trackbed
