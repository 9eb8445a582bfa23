#pragma once

#include <vector>

#include "render/overlay.h"
#include "render/palette.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// Returns the style of a car's trail. A trail is narrower than the lines that it covers, so that
/// all remain visible, as on a transport map.
RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale);

/// The path that a car's rear-axle center has driven, up to the time of the picture.
class Trail {
 public:
  /// Makes a trail in the car's color or, if `colors` is not empty, with a separate color for each
  /// recorded state. The recording must outlive the trail.
  Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors = {});

  [[nodiscard]] std::size_t max_shapes() const { return points_.size(); }
  /// Adds the pieces of the trail to the scene. If the trail has colors, each piece has the color
  /// of its first point; otherwise all have the color of `style`.
  void AddShapes(SceneContext& context, RibbonStyle style) const;

 private:
  const Recording& recording_;
  std::size_t car_;
  std::vector<Point> points_;  // Points of the thinned trail.
  std::vector<double> times_;  // Time at each point [s].
  std::vector<Color> colors_;  // Color at each point; may be empty.
};

/// Returns the overlay that draws the trails of the car and, if shown, of the ghosts.
OverlayEntry TrailOverlay();

}  // namespace trackbed::render
