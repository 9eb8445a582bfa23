#pragma once

#include <vector>

#include "render/overlay.h"
#include "render/palette.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// Style of a car's trail: narrower than the lines that it covers, like lines of a transport map.
RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale);

/// The path of a car's rear-axle center, up to the time of the picture.
class Trail {
 public:
  /// Draws the trail in the car's color, or with a color for each recorded state. The recording
  /// must outlive the trail.
  Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors = {});

  [[nodiscard]] std::size_t max_shapes() const { return points_.size(); }
  /// If the trail has colors, a piece has the color of its first point; otherwise it has that of
  /// `style`.
  void AddShapes(SceneContext& context, RibbonStyle style) const;

 private:
  const Recording& recording_;
  std::size_t car_;
  std::vector<Point> points_;  // Points of the thinned trail.
  std::vector<double> times_;  // Time at each point [s].
  std::vector<Color> colors_;  // Color at each point; may be empty.
};

/// The trails of the car and, if shown, of the ghosts.
OverlayEntry TrailOverlay();

}  // namespace trackbed::render
