#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "render/canvas.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// The force of a tyre on the car at a given time, and the tyre's friction limit.
struct WheelForce {
  Eigen::Vector3d place;    ///< Point on the ground under the wheel's hub.
  Eigen::Vector3d forward;  ///< Unit vector along the ground in the rolling direction of the wheel.
  Eigen::Vector3d left;     ///< Unit vector along the ground to the left of the wheel.
  Vec2 force;  ///< Tyre force in the rolling direction and to the left of the wheel [N].
  /// Half axes of the friction ellipse [N]: friction times load, along and across the rolling
  /// direction.
  Vec2 most;
  int body = -1;          ///< Index of the wheel's body in the model.
  std::size_t wheel = 0;  ///< Index of the wheel in kWheels of car_model.h.

  /// Returns the used fraction of the tyre's available friction, which is 1 on the friction
  /// ellipse. For some tyre laws, the used fraction may slightly exceed 1.
  [[nodiscard]] double Use() const;
};

/// Reads the tyre forces of a recorded car from the car's log.
class TyreForces {
 public:
  /// Reads the tyre forces of the car, `recording.plants.front()`. The recording must outlive this
  /// TyreForces object.
  explicit TyreForces(const Recording& recording);

  /// Whether the car's log contains tyre forces and the model has the corresponding wheels.
  [[nodiscard]] bool known() const { return !wheels_.empty(); }
  /// Returns the tyre force of each wheel that carries a load. The argument `data` must have the
  /// car's pose at `time` [s].
  [[nodiscard]] std::vector<WheelForce> At(double time, const mjData& data) const;

 private:
  struct Wheel {
    std::size_t index = 0;
    int joint = -1;  // index of the wheel's spin joint
    int body = -1;
    // Indices of the log columns with the load and the longitudinal and lateral force.
    std::array<std::size_t, 3> columns{};
    // Longitudinal and lateral friction coefficient of the tyre at the nominal load.
    Vec2 friction{0.0, 0.0};
    // Change of the friction coefficients when the load increases by the nominal load.
    Vec2 friction_per_load{0.0, 0.0};
    // Nominal load of the tyre [N]; 0 if friction does not depend on the load.
    double nominal_load = 0.0;
  };

  [[nodiscard]] std::optional<Wheel> FindWheel(const char* name, const char* axle) const;

  const Recording& recording_;
  std::vector<Wheel> wheels_;
};

/// Fraction of a tyre's grip above which the tyre leaves a skid mark and its dial turns red.
inline constexpr double kSkidUse = 0.9;

/// Draws the used fraction of a tyre's grip as a hand from the center of a dial. The hand of the
/// dial points up for a forward force, and left for a force to the left. At the friction limit, the
/// dial's hand ends on the rim of the dial, at `radius` [px]. Beyond the friction limit, the dial's
/// hand extends past the rim by at most an eighth of the radius. If `tyre` is null, the wheel
/// carries no load and an empty dial is drawn. The argument `hairline` is the thickness of the
/// dial's rim [px].
void DrawGripDial(Canvas& canvas, const CanvasPoint& center, double radius, const WheelForce* tyre,
                  double hairline);

/// Returns the overlay that draws a panel of dials, one per tyre of the car, arranged like the
/// wheels. The panel of dials is shown only if the car's log has tyre forces.
OverlayEntry ForceOverlay();

}  // namespace trackbed::render
