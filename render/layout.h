#pragma once

#include <algorithm>
#include <cmath>

#include "render/image.h"

/// Sizes of the panels and text that are drawn over a frame.
namespace trackbed::render {

inline constexpr Color kPanel{0.06F, 0.07F, 0.09F};
inline constexpr double kPanelAlpha = 0.66;
inline constexpr Color kLabel{0.70F, 0.74F, 0.78F};
inline constexpr Color kValue{1.00F, 1.00F, 1.00F};

/// Sizes of the panels and text of a frame [px]. The sizes of panels and text are proportional to
/// the frame's height, with a minimum that keeps text readable down to 640x360. In frames smaller
/// than 640x360, panels and text shrink further to fit.
struct Layout {
  double margin;  ///< Distance from the edge of the frame to a panel.
  double pad;     ///< Distance from a panel's edge to its text.
  double label;   ///< Height of the cell of a character.
  double value;
  double gap;       ///< Horizontal gap between columns of text.
  double hairline;  ///< Thickness of thin lines in panels.

  Layout(int width, int height) {
    const double scale = height / 720.0;
    // At the smallest readable size of letters, legend and title side by side need a width of about
    // 400 px. At the smallest readable size of letters, all panels stacked vertically need a height
    // of 250 px.
    const double shrink = std::min({1.0, width / 400.0, height / 270.0});
    // In tall, narrow frames, such as two frames side by side, the width limits the sizes of texts
    // and panels.
    const double widest = width / 960.0;
    const auto size = [&](double of_height, double least) {
      return std::max(of_height * std::min(scale, widest), least * shrink);
    };
    margin = size(20.0, 10.0);
    pad = size(14.0, 8.0);
    label = std::round(size(23.0, 16.0));
    value = std::round(size(36.0, 22.0));
    gap = size(30.0, 16.0);
    hairline = size(2.0, 1.2);
  }
  /// Radius of the rounded corners of a panel.
  [[nodiscard]] double round() const { return 0.7 * pad; }
};

}  // namespace trackbed::render
