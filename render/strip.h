#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/canvas.h"
#include "render/layout.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// A panel at the bottom of the picture over the time of the whole run. The panel shows the planned
/// curvature at the car's position, and the commanded and actual steering up to now. The axes of
/// the panel end at the recording's scales.
class Strip {
 public:
  /// Makes the panel for pictures of this size [px].
  Strip(const Recording& recording, int width, int height, Font& font);

  /// Top of the strip's panel [px].
  [[nodiscard]] double top() const { return panel_.top; }
  void Draw(Image& image, Font& font, double time) const;

 private:
  /// Coverage of each pixel of the plot by a curve, 0 to 255, rows from the top.
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
  // Left, top and size of the plot in whole pixels.
  int left_ = 0;
  int top_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  Mask curvature_;
  Mask command_;
  Mask actual_;
  std::vector<Label> labels_;
};

/// The overlay that draws the strip; other panels are placed above it.
OverlayEntry StripOverlay();

}  // namespace trackbed::render
