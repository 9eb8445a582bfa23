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

/// A tyre's force on the car at a given time, and its friction limit.
struct WheelForce {
  Eigen::Vector3d place;    ///< Point on the ground under the hub.
  Eigen::Vector3d forward;  ///< Unit vector along the ground in rolling direction.
  Eigen::Vector3d left;     ///< Unit vector along the ground to the left.
  Vec2 force;               ///< Tyre force along `forward` and `left` [N].
  Vec2 most;                ///< Half axes of the friction ellipse: friction times load, along and
                            ///< across [N].
  int body = -1;            ///< The wheel's body in the model.
  std::size_t wheel = 0;    ///< Index of the wheel in kWheels of car_model.h.

  /// Returns the used fraction of the available friction, which is 1 on the friction ellipse. With
  /// some tyre laws, the used fraction may slightly exceed 1.
  [[nodiscard]] double Use() const;
};

/// The tyre forces of a recorded car, read from its log.
class TyreForces {
 public:
  /// Reads the tyre forces of the car, `recording.plants.front()`. The recording must outlive this
  /// object.
  explicit TyreForces(const Recording& recording);

  /// Whether the log has tyre forces and the model has the corresponding wheels.
  [[nodiscard]] bool known() const { return !wheels_.empty(); }
  /// Returns the tyre force of each wheel that carries a load. `data` must have the car's pose at
  /// `time` [s].
  [[nodiscard]] std::vector<WheelForce> At(double time, const mjData& data) const;

 private:
  struct Wheel {
    std::size_t index = 0;
    int joint = -1;  // index of the wheel's spin joint
    int body = -1;
    std::array<std::size_t, 3> columns{};  // Columns of the load and of the longitudinal and
                                           // lateral force.
    Vec2 friction{0.0, 0.0};               // Longitudinal and lateral friction coefficient at the
                                           // nominal load.
    Vec2 friction_per_load{0.0, 0.0};      // Change of the friction coefficients when the load
                                           // rises by the nominal load.
    double nominal_load = 0.0;  // Nominal load [N]; 0 if friction does not depend on the load.
  };

  [[nodiscard]] std::optional<Wheel> FindWheel(const char* name, const char* axle) const;

  const Recording& recording_;
  std::vector<Wheel> wheels_;
};

/// Used fraction of a tyre's grip above which the tyre leaves a skid mark and its dial turns red.
inline constexpr double kSkidUse = 0.9;

/// Draws the used grip of a tyre as a hand from the center of a dial. The hand points up for a
/// forward force, and left for a force to the left. At the friction limit, the hand ends on the
/// rim, at `radius` [px]. Beyond the friction limit, the hand extends past the rim by at most an
/// eighth of the radius. If `tyre` is null, the wheel carries no load and the dial is empty.
/// `hairline` is the thickness of the dial's rim [px].
void DrawGripDial(Canvas& canvas, const CanvasPoint& center, double radius, const WheelForce* tyre,
                  double hairline);

/// Returns the overlay that draws a panel of dials, one per tyre of the car, arranged like the
/// wheels. The panel is shown only if the car's log has tyre forces.
OverlayEntry ForceOverlay();

}  // namespace trackbed::render
