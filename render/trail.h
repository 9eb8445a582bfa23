#pragma once

#include <vector>

#include "render/overlay.h"
#include "render/palette.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// Returns the style of the line that shows a car's trail. A trail is narrower than the lines that
/// it covers, so that all lines remain visible, as on a transport map.
RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale);

/// The trail of a car: the path that its rear-axle center has driven up to the time of the frame.
class Trail {
 public:
  /// Makes a trail in the car's color or, if `colors` is not empty, with a separate color for each
  /// recorded state. The recording must outlive the trail.
  Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors = {});

  [[nodiscard]] std::size_t max_shapes() const { return points_.size(); }
  /// Adds the pieces of the trail to the scene. If the trail has separate colors, each piece has
  /// the color of its first point; otherwise all pieces have the color of `style`.
  void AddShapes(SceneContext& context, RibbonStyle style) const;

 private:
  const Recording& recording_;
  std::size_t car_;
  std::vector<Point> points_;  // Positions of the points of the thinned trail.
  std::vector<double> times_;  // Time at which the car passes each point of the thinned trail [s].
  std::vector<Color> colors_;  // Color at each point of the thinned trail; may be empty.
};

/// Returns the overlay that draws the trails of the car and, if shown, of the ghosts.
OverlayEntry TrailOverlay();

}  // namespace trackbed::render
