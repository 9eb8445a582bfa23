#pragma once

#include <vector>

#include "render/overlay.h"
#include "render/palette.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// The line that a car leaves: narrower than those it covers, like the lines of a transport map.
RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale);

/// The track of a car's rear-axle center, up to the moment of the picture.
class Trail {
 public:
  /// In the car's color, or with a color for each of its recorded states. The recording outlives
  /// it.
  Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors = {});

  [[nodiscard]] std::size_t max_shapes() const { return points_.size(); }
  /// In colors of its own it has the color of the point where a piece begins.
  void AddShapes(SceneContext& context, RibbonStyle style) const;

 private:
  const Recording& recording_;
  std::size_t car_;
  std::vector<Point> points_;  // thinned
  std::vector<double> times_;  // when each was reached [s]
  std::vector<Color> colors_;  // likewise of each, or none
};

/// The trails of the car and, where ghosts are shown, of these.
OverlayEntry TrailOverlay();

}  // namespace trackbed::render
