#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/canvas.h"
#include "render/layout.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// A chart at the bottom of the frame, whose time axis covers the whole run. The chart shows the
/// planned curvature at the car's position, and the commanded and actual steering angle up to the
/// frame's time. The ends of the vertical axes are determined by Recording::scales.
class Strip {
 public:
  /// Makes the chart for frames with the given width and height [px].
  Strip(const Recording& recording, int width, int height, Font& font);

  /// Returns the top row of the chart's panel [px].
  [[nodiscard]] double top() const { return panel_.top; }
  void Draw(Image& image, Font& font, double time) const;

 private:
  /// Coverage of each pixel of the plot by a curve, from 0 to 255, with rows from the top.
  using Mask = std::vector<std::uint8_t>;

  struct Label {
    double left;
    Color color;
    std::string text;
  };

  [[nodiscard]] double PixelColumn(double time) const;
  [[nodiscard]] Mask MakeMask(const Image& drawn) const;
  void Blend(Image& image, const Mask& mask, Color color, double alpha, int first, int last) const;

  double begin_;  // [s]
  double end_;
  Layout layout_;
  Canvas::Rectangle panel_;
  // Left edge, top edge and size of the chart's plot, in whole pixels.
  int left_ = 0;
  int top_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  Mask curvature_;
  Mask command_;
  Mask actual_;
  std::vector<Label> labels_;
};

/// Returns the overlay that draws the chart of curvature and steering. Panels of later overlays are
/// placed above the chart.
OverlayEntry StripOverlay();

}  // namespace trackbed::render
