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

/// A tyre's force on the car at a moment, and what friction allows it.
struct WheelForce {
  Eigen::Vector3d place;    ///< on the ground under the hub
  Eigen::Vector3d forward;  ///< unit vectors along the ground: where the wheel rolls to,
  Eigen::Vector3d left;     ///< and across
  Vec2 force;               ///< along them [N]
  Vec2 most;                ///< half axes of the ellipse that friction times load is [N]
  int body = -1;            ///< of the wheel, in the model
  std::size_t wheel = 0;    ///< its index in kWheels of car_model.h

  /// How much of the friction is used: 1 on the ellipse. Tyre laws may give a little more.
  [[nodiscard]] double Use() const;
};

/// The forces of a recorded car whose log has them.
class TyreForces {
 public:
  /// Of the car, `recording.plants.front()`, whose lifetime must be longer.
  explicit TyreForces(const Recording& recording);

  /// Whether the log has forces and the model the wheels that they are of.
  [[nodiscard]] bool known() const { return !wheels_.empty(); }
  /// One per wheel that carries load. `data` is posed at `time` [s].
  [[nodiscard]] std::vector<WheelForce> At(double time, const mjData& data) const;

 private:
  struct Wheel {
    std::size_t index = 0;
    int joint = -1;  // about which it spins
    int body = -1;
    std::array<std::size_t, 3> columns{};  // load, along, across
    Vec2 friction{0.0, 0.0};               // along, across, at the nominal load
    Vec2 friction_per_load{0.0, 0.0};      // their change with load over the nominal one
    double nominal_load = 0.0;             // [N]; 0: friction does not depend on the load
  };

  [[nodiscard]] std::optional<Wheel> FindWheel(const char* name, const char* axle) const;

  const Recording& recording_;
  std::vector<Wheel> wheels_;
};

/// The share of its grip that a tyre of the car has to use for a skid mark, and for its dial to be
/// red.
inline constexpr double kSkidUse = 0.9;

/// Draws how much of its grip a tyre uses: a line from the middle, up for a force forward and to
/// the left for one to the left, that ends on the rim, at `radius` [px], where all of it is used,
/// and beyond the rim by at most an eighth of the radius. No tyre: it carries no load, and the dial
/// is empty. `hairline` is the thickness of the rim [px].
void DrawGripDial(Canvas& canvas, const CanvasPoint& center, double radius, const WheelForce* tyre,
                  double hairline);

/// A panel of dials, one for each tyre of the car whose log has forces, as its wheels stand.
OverlayEntry ForceOverlay();

}  // namespace trackbed::render
