#pragma once

#include <vector>

#include "render/overlay.h"
#include "render/palette.h"
#include "render/ribbon.h"

namespace trackbed::render {

/// Style of a car's trail: narrower than the lines it covers, like lines of a transport map.
RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale);

/// The path of a car's rear-axle center, up to the time of the picture.
class Trail {
 public:
  /// In the car's color, or with a color for each of its recorded states. The recording must
  /// outlive the trail.
  Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors = {});

  [[nodiscard]] std::size_t max_shapes() const { return points_.size(); }
  /// A piece has the color of its first point, if there are colors; otherwise that of `style`.
  void AddShapes(SceneContext& context, RibbonStyle style) const;

 private:
  const Recording& recording_;
  std::size_t car_;
  std::vector<Point> points_;  // thinned
  std::vector<double> times_;  // time at each point [s]
  std::vector<Color> colors_;  // at each point; may be empty
};

/// The trails of the car and, if shown, of the ghosts.
OverlayEntry TrailOverlay();

}  // namespace trackbed::render
