#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/sim/stability_control.h"
#include "src/sim/wheel_slip_control.h"
#include "trackbed/sim/driver_aids.h"

struct mjData_;

namespace trackbed {

/// The driver aids of a car on Magic Formula tyres: anti-lock brakes, stability control, and a
/// locked or limited-slip differential on each driven axle.
class DriverAids {
 public:
  /// An axle whose two wheels are driven.
  struct DrivenAxle {
    std::size_t first = 0;     ///< Index of the left wheel; the right wheel has the next index.
    double drive_share = 0.0;  ///< Sum of the drive torques on both wheels, per unit of the drive
                               ///< control.
  };

  /// The argument `data` is the car's state at the start, after mj_forward. Throws InputError if
  /// the car has no driven axle for the differential.
  DriverAids(const AidOptions& options, const CarModel& car, const mjModel_& model,
             const mjData_& data);

  /// Updates the brake torques for the coming step. `brakes` contains the brake torque that the
  /// driver commands for each wheel [N m].
  void Update(const CarMotion& motion, const std::array<WheelMotion, 4>& wheels,
              const std::array<double, 4>& brakes, double timestep);

  /// Returns the brake torque of each wheel [N m].
  [[nodiscard]] const std::array<double, 4>& brake_torque() const { return torque_; }
  /// Returns the fraction of the commanded drive torque that stability control permits.
  [[nodiscard]] double drive_share() const { return esc_ ? esc_->state().drive_share : 1.0; }
  /// Returns the axles with a locked or limited-slip differential.
  [[nodiscard]] const std::vector<DrivenAxle>& coupled_axles() const { return coupled_; }
  /// Returns the largest torque [N m] that the differential transmits from one wheel to the other
  /// if the torque `drive` [N m] drives the axle.
  [[nodiscard]] double LargestCoupling(double drive) const;
  /// Stores the sum of the torques that the differentials transmit to the left wheels in the
  /// present step [N m].
  void SetCoupling(double torque) { coupling_ = torque; }

  [[nodiscard]] AidState state() const;

 private:
  [[nodiscard]] double FrontTorque(double timestep);
  [[nodiscard]] double RearTorque() const;

  AidOptions options_;
  std::vector<DrivenAxle> coupled_;
  double preload_ = 0.0;  // Preload torque: largest torque difference of the two wheels without
                          // drive torque [N m].
  double ramp_ = 0.0;
  double coupling_ = 0.0;
  double mass_;
  std::array<double, 4> largest_{};  // Largest brake torque of each wheel [N m].
  std::vector<WheelSlipControl> slip_;
  // Permitted excess of one front wheel's brake torque over that of the other (FrontTorque) [N m].
  double front_excess_ = 0.0;
  std::optional<StabilityControl> esc_;
  std::array<double, 4> esc_torque_{};  // Brake torque that stability control adds at each wheel [N
                                        // m].
  std::array<double, 4> torque_{};
  std::array<bool, 4> limited_{};  // For each wheel, whether its brake torque is limited below the
                                   // command.
};

}  // namespace trackbed
