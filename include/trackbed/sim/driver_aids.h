#pragma once

#include <array>
#include <optional>

/// Driver aids of a car, simulated by the MuJoCo plant with Magic Formula tyres at every physics
/// step (docs/aids.md).
namespace trackbed {

/// Distribution of the drive torque between the two wheels of a driven axle.
enum class Differential {
  kOpen,    ///< Open: both wheels get the same torque at any speed difference.
  kLocked,  ///< Locked: both wheels of the axle turn at the same speed.
  /// Limited slip: a clutch transmits torque from the axle's faster to its slower wheel.
  kLimitedSlip,
};

/// The driver aids of a car. All driver aids are off by default.
struct AidOptions {
  bool abs = false;  ///< Anti-lock brakes: slip control of each wheel, select-low on the rear axle.
  bool esc = false;  ///< Electronic stability control: brakes single wheels and reduces the drive.
  Differential differential = Differential::kOpen;
  /// Largest difference between the torques of the two wheels at zero drive torque [N m], >= 0;
  /// only for kLimitedSlip. Default: 0.02 m g R.
  std::optional<double> differential_preload{};
  /// Increase of the largest torque difference per drive torque of the axle [1], from 0 to 1; only
  /// for kLimitedSlip. Default: 0.25.
  std::optional<double> differential_ramp{};

  /// Whether the car has any driver aid.
  [[nodiscard]] bool any() const { return abs || esc || differential != Differential::kOpen; }
};

/// State of the stability control of a car.
struct EscState {
  double yaw_rate_reference = 0.0;  ///< Yaw rate that corresponds to the driver's steering [rad/s].
  /// Brake torque that stability control applies to each wheel in addition to the driver's brake
  /// torque [N m], >= 0; in the order of kWheels.
  std::array<double, 4> brake_torque{};
  /// Share of the driver's drive torque that stability control lets through, from 0 to 1.
  double drive_share = 1.0;
};

/// States of the driver aids of a car; an aid that is off has no state.
struct AidState {
  /// Whether anti-lock control holds the brake torque of a wheel below the commanded torque, in the
  /// order of kWheels.
  std::optional<std::array<bool, 4>> abs_active{};
  std::optional<EscState> esc{};
  /// Torque that a locked or limited-slip differential transmits from the right to the left wheel
  /// of the driven axle [N m]. If both axles are driven, this torque is the sum over both axles.
  std::optional<double> differential_torque{};
};

}  // namespace trackbed
