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
  Eigen::Vector3d place;    ///< on the ground under the hub
  Eigen::Vector3d forward;  ///< unit vector along the ground in rolling direction
  Eigen::Vector3d left;     ///< unit vector along the ground to the left
  Vec2 force;               ///< along `forward` and `left` [N]
  Vec2 most;                ///< half axes of the friction ellipse, friction times load [N]
  int body = -1;            ///< the wheel's body in the model
  std::size_t wheel = 0;    ///< its index in kWheels of car_model.h

  /// The used fraction of the friction: 1 on the ellipse. Tyre laws may slightly exceed 1.
  [[nodiscard]] double Use() const;
};

/// The tyre forces of a recorded car whose log has them.
class TyreForces {
 public:
  /// Forces of the car, `recording.plants.front()`. The recording must outlive this object.
  explicit TyreForces(const Recording& recording);

  /// Whether the log has forces and the model the corresponding wheels.
  [[nodiscard]] bool known() const { return !wheels_.empty(); }
  /// The force of each loaded wheel. `data` must be posed at `time` [s].
  [[nodiscard]] std::vector<WheelForce> At(double time, const mjData& data) const;

 private:
  struct Wheel {
    std::size_t index = 0;
    int joint = -1;  // the spin joint
    int body = -1;
    std::array<std::size_t, 3> columns{};  // load, along, across
    Vec2 friction{0.0, 0.0};               // along, across, at the nominal load
    Vec2 friction_per_load{0.0, 0.0};      // change with load, relative to the nominal load
    double nominal_load = 0.0;             // [N]; 0: friction does not depend on the load
  };

  [[nodiscard]] std::optional<Wheel> FindWheel(const char* name, const char* axle) const;

  const Recording& recording_;
  std::vector<Wheel> wheels_;
};

/// Used fraction of a tyre's grip from which it leaves a skid mark and its dial is red.
inline constexpr double kSkidUse = 0.9;

/// Draws the used grip of a tyre: a line from the center, up for a forward force and to the left
/// for a force to the left. It ends on the rim, at `radius` [px], at the friction limit, and beyond
/// it by at most an eighth of the radius. For null, a wheel without load, the dial is empty.
/// `hairline` is the thickness of the rim [px].
void DrawGripDial(Canvas& canvas, const CanvasPoint& center, double radius, const WheelForce* tyre,
                  double hairline);

/// A panel of dials, one per tyre of the car, arranged like its wheels, if the log has forces.
OverlayEntry ForceOverlay();

}  // namespace trackbed::render
